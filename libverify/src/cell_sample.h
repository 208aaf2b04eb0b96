#pragma once

#include <functional>
#include <optional>
#include <span>

#include "arrangement.h"
#include "number.h"

namespace kaboum::verify {

/// A point of a face's interior, displaced infinitesimally within the face, as a representative of
/// a cell. The point is given by barycentric weights ≥ 0, up to a positive factor.
struct CellSample {
  std::uint32_t face;
  Triple<Exact> exact;
  Triple<Approx> approx;
  /// The displacement goes to the side of this line where it is positive (a linear function of
  /// barycentric coordinates, zero at the point); absent: in any direction.
  std::optional<Triple<Exact>> line;
};

/// The middle of a face.
CellSample middle_sample(std::uint32_t face);

/// Rounded coordinates.
Vec3 position(const MeshPair& meshes, const CellSample& sample);

/// Called with a sample; returns false when it has seen enough.
using SampleVisitor = std::function<bool(const CellSample&)>;

/// Visits one sample at least in each cell that the chains of `mask` cut the face into.
///
/// @param limit    of the number of pieces of lines on the face
/// @param decided  cells that lie on one of these coplanar faces, each of them left whole by its
/// own
///   chain, may be left out: perhaps all
/// @pre the contacts of the mask's chains with the face's chain are known.
/// @throws Error{LimitReached} beyond `limit`.
void visit_samples(const Arrangement& arrangement, std::uint32_t face, OperandMask mask,
                   std::size_t limit, std::span<const std::uint32_t> decided,
                   const SampleVisitor& visitor);

/// Winding number of a chain on one side of the face at the sample; exact.
/// @pre the chain is closed.
int winding(const MeshPair& meshes, const CellSample& sample, Side side, int chain);

/// Outside's minus inside's; for open chains with the same border, too.
int winding_difference(const MeshPair& meshes, const CellSample& sample, Side side);

/// Winding number of a closed chain at a point; nullopt on its surface. Exact.
std::optional<int> winding_at(const MeshPair& meshes, int chain, const Vec3& p);

}  // namespace kaboum::verify
