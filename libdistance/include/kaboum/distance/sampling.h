#pragma once

#include <kaboum/geom/triangle_search.h>

#include <cstdint>
#include <functional>

namespace kaboum::distance {

/// An estimate from random samples and its standard error (one standard deviation).
struct Estimate {
  double value = 0;
  double standard_error = 0;
};

/// Mean and root mean square of d(x, B) over the area of A. [length]
struct Sampled {
  Estimate mean, rms;
  double rounding = 0;  ///< what rounding of points and distances can move either by at most
  std::uint64_t samples = 0;
};

/// Stratified sampling: A's triangles, one after the other, make a strip of length area(A), which
/// is cut into samples/2 equal strata; each gets two independent points, uniformly distributed,
/// whose difference estimates the variance inside the stratum. Random numbers depend on the seed
/// and the stratum alone, so the result does not depend on the number of threads.
///
/// @param samples  rounded up to an even number, at least 2. A surface without area is sampled as
///   if its triangles had equal areas.
/// @param distance  from a point, given its distance to B's triangles, which it is when there is no
///   such function. Called from several threads.
/// @throws Error{InvalidInput} when A has no triangles.
Sampled sample_distances(
    const geom::Mesh& a, const geom::TriangleSearch& b, std::uint64_t samples, std::uint64_t seed,
    const std::function<double(const geom::Vec3&, double)>& distance = nullptr);

}  // namespace kaboum::distance
