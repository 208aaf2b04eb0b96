#pragma once

#include <set>
#include <span>
#include <utility>
#include <vector>

#include "arrangement.h"
#include "number.h"

/// The lines in which other faces meet a face, in barycentric coordinates; exact.
/// docs/algorithms/exact-inclusion.md, "Samples".
namespace kaboum::verify {

/// A segment within the face: barycentric coordinates of its ends (non-negative up to a positive
/// factor) and of its line (linear function, zero on it).
struct Segment {
  Triple<Exact> line, p, q;
  Triple<Approx> approx_line, approx_p, approx_q;
  std::array<double, 4> box;  ///< of the first two coordinates, normalised: low, low, high, high
};

/// The segments in which the chains of a mask cut a face.
///
/// @param limit    of their number
/// @param decided  edges between two of these coplanar faces are left out
/// @pre the contacts of the mask's chains with the face's chain are known
/// @throws Error{LimitReached} beyond `limit`
std::vector<Segment> segments_of(const Arrangement& arrangement, std::uint32_t face,
                                 OperandMask mask, std::size_t limit,
                                 std::span<const std::uint32_t> decided);

Triple<Approx> rounded(const Triple<Exact>& x);
Triple<Exact> cross(const Triple<Exact>& a, const Triple<Exact>& b);
Triple<Exact> combine(const Exact& x, const Triple<Exact>& a, const Exact& y,
                      const Triple<Exact>& b);
/// Weights of a point, times −1 if their sum is negative.
Triple<Exact> made_positive(Triple<Exact> a);
/// On which side of a line a point is.
Sign sign_on(const Triple<Approx>& approx_line, const Triple<Exact>& line,
             const Triple<Approx>& approx_point, const Triple<Exact>& point);
/// A power of two by which b's weights are about the multiple of a's.
double ratio_of(const Triple<Exact>& a, const Triple<Exact>& b);

/// A weight of a point as a part of its total, which is 1.
Approx share(const Approx& weight, const Approx& total);
/// The sum of weights.
Approx total_of(const Triple<Approx>& weights);
/// Whether one can divide by it.
bool usable(const Approx& total);

}  // namespace kaboum::verify
