// Mean and root mean square distances from samples, spread over the area and the same for any
// number of threads.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/distance/sampling.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kaboum::distance {
namespace {

using geom::Vec3;

/// Random numbers that depend on a seed and a stream number alone: SplitMix64 (Steele, Lea, Flood
/// 2014).
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : state_(mix(seed) ^ mix(~stream)) {}
  /// Uniform in [0, 1).
  double uniform() {
    state_ += 0x9e3779b97f4a7c15U;
    return static_cast<double>(mix(state_) >> 11) * 0x1p-53;
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

/// Sums over strata: of the distances, their squares, and the squared differences in pairs.
struct Sums {
  double distance = 0, square = 0, distance_spread = 0, square_spread = 0;
  double width = 0;  // of the widest bracket
};

}  // namespace

Sampled sample_distances(const geom::Mesh& a, const geom::TriangleSearch& b, std::uint64_t samples,
                         std::uint64_t seed, const std::function<double(const Vec3&, double)>& of) {
  if (a.empty()) throw Error(ErrorCode::InvalidInput, "distance from a mesh without triangles");
  const geom::Box3 box = geom::bounding_box(a);
  const double scale = box.diagonal() > 0 ? 1 / box.diagonal() : 1;  // keeps products in range
  std::vector<double> end(a.triangles.size());                       // cumulated areas
  double total = 0;
  for (std::size_t t = 0; t < end.size(); ++t) {
    const auto& [i, j, k] = a.triangles[t];
    const Vec3 u = scale * (a.vertices[j] - a.vertices[i]);
    const Vec3 v = scale * (a.vertices[k] - a.vertices[i]);
    end[t] = total += 0.5 * u.cross(v).norm();
  }
  if (!(total > 0)) {
    std::iota(end.begin(), end.end(), 1.0);
    total = end.back();
  }

  const std::uint64_t strata = std::max<std::uint64_t>(1, samples / 2 + samples % 2);
  constexpr std::uint64_t kBlock = 256;  // hints pass on within blocks, not the scheduler's ranges
  const std::uint64_t blocks = (strata + kBlock - 1) / kBlock;
  std::vector<Sums> sums(blocks);
  parallel_for(std::uint64_t{0}, blocks, [&](std::uint64_t block) {
    std::uint32_t hint = geom::TriangleSearch::kNone;
    Sums& sum = sums[block];
    for (std::uint64_t s = block * kBlock; s < std::min(strata, (block + 1) * kBlock); ++s) {
      Random random(seed, s);
      double distance[2];
      for (double& d : distance) {
        const double at =
            total * ((static_cast<double>(s) + random.uniform()) / static_cast<double>(strata));
        // The first triangle that ends behind `at`; those without area are never chosen.
        const auto t = static_cast<std::size_t>(
            std::min(std::upper_bound(end.begin(), end.end(), at), end.end() - 1) - end.begin());
        const auto& [i, j, k] = a.triangles[t];
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        const Vec3 p = a.vertices[i] + u * (a.vertices[j] - a.vertices[i]) +
                       v * (a.vertices[k] - a.vertices[i]);
        const auto nearest = b.nearest(p, hint);
        hint = nearest.triangle;
        d = 0.5 * nearest.lower + 0.5 * nearest.upper;
        if (of) d = of(p, d);
        sum.width = std::max(sum.width, nearest.upper - nearest.lower);
      }
      // Scaled, so that squares stay in the range of double.
      const double x = scale * distance[0], y = scale * distance[1];
      sum.distance += x + y;
      sum.square += x * x + y * y;
      sum.distance_spread += (x - y) * (x - y);
      sum.square_spread += (x * x - y * y) * (x * x - y * y);
    }
  });
  Sums all;
  for (const Sums& s : sums) {
    all.width = std::max(all.width, s.width);
    all.distance += s.distance;
    all.square += s.square;
    all.distance_spread += s.distance_spread;
    all.square_spread += s.square_spread;
  }
  // Per stratum the variance of one point is estimated by (x − y)²/2, that of the stratum's mean by
  // (x − y)²/4; the mean over n strata has 1/n² times the sum of these.
  const auto n = static_cast<double>(strata);
  Sampled result;
  result.samples = 2 * strata;
  result.mean = {all.distance / (2 * n) / scale, std::sqrt(all.distance_spread) / (2 * n) / scale};
  const double rms = std::sqrt(all.square / (2 * n));
  // d(√m) = dm / (2√m).
  result.rms = {rms / scale,
                rms > 0 ? std::sqrt(all.square_spread) / (2 * n) / (2 * rms) / scale : 0.0};
  // docs/algorithms/distances.md.
  result.rounding =
      0.5 * all.width + 2e-15 * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  return result;
}

}  // namespace kaboum::distance
