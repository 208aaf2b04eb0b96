// How many bodies are certainly too few: of more points than bodies, two are in the same one.
// docs/algorithms/convex-decomposition.md, "More bodies".

#include "body_bound.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <numeric>

namespace kaboum::bcd {
namespace {

/// Corners looked at: so many times the bodies, between these.
constexpr std::size_t kCornersPerBody = 6, kFewestCorners = 64, kMostCorners = 320;
/// Where the way between two corners is looked at: the middle first, which is the farthest mostly.
constexpr std::array<double, 5> kOnTheWay{0.5, 0.3, 0.7, 0.15, 0.85};
/// More than the rounding of points on the way, and of distances.
constexpr double kRoundedAway = 1e-9;
/// About what a point takes that is looked at. [ns]
constexpr std::uint64_t kPointWork = 500;

/// Corners from all over the mesh's list.
std::vector<Vec3> corners_of(const Mesh& mesh, std::size_t most) {
  const std::vector<Vec3>& all = mesh.vertices;
  const std::size_t count = std::min(most, all.size());
  std::vector<Vec3> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(all[i * all.size() / count]);
  return out;
}

/// Pairs of corners that no body within the distance contains both of.
class Apart {
 public:
  Apart(const std::vector<Vec3>& corners, const SolidField& solid, double distance)
      : count_(corners.size()), apart_(count_ * count_, 0) {
    const double least = (1 + kRoundedAway) * distance + kRoundedAway * solid.diagonal();
    parallel_for(std::size_t{0}, count_, [&](std::size_t i) {
      for (std::size_t j = 0; j < i; ++j)
        apart_[i * count_ + j] = leads_away(corners[i], corners[j], solid, least) ? 1 : 0;
    });
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = 0; j < i; ++j) apart_[j * count_ + i] = apart_[i * count_ + j];
  }

  [[nodiscard]] bool operator()(std::size_t i, std::size_t j) const {
    return apart_[i * count_ + j] != 0;
  }

  /// Corners that are all apart from each other, at most `most`: each time the one that leaves most
  /// of the others.
  [[nodiscard]] std::size_t clique(std::size_t most) const {
    std::vector<std::size_t> left(count_);
    std::iota(left.begin(), left.end(), std::size_t{0});
    std::size_t size = 0;
    while (!left.empty() && size < most) {
      std::vector<std::size_t> kept(left.size());
      parallel_for(std::size_t{0}, left.size(), [&](std::size_t a) {
        kept[a] = static_cast<std::size_t>(
            std::count_if(left.begin(), left.end(), [&](std::size_t j) { return (*this)(left[a], j); }));
      });
      const std::size_t chosen = left[static_cast<std::size_t>(
          std::max_element(kept.begin(), kept.end()) - kept.begin())];
      std::erase_if(left, [&](std::size_t j) { return !(*this)(chosen, j); });
      ++size;
    }
    return size;
  }

 private:
  /// Whether a point between the two is farther than `least` from the solid.
  static bool leads_away(const Vec3& a, const Vec3& b, const SolidField& solid, double least) {
    if ((b - a).norm() < 2 * least) return false;
    return std::any_of(kOnTheWay.begin(), kOnTheWay.end(), [&](double t) {
      const Vec3 p = a + t * (b - a);
      solid.work().add(kPointWork);
      return solid.surface().within(p, least) == geom::TriangleSearch::kNone && !solid.contains(p);
    });
  }

  std::size_t count_;
  std::vector<char> apart_;
};

}  // namespace

std::size_t too_few_bodies(const Mesh& mesh, const SolidField& solid, double distance,
                           std::size_t most) {
  const std::size_t corners = std::clamp(kCornersPerBody * most, kFewestCorners, kMostCorners);
  const std::size_t clique =
      Apart(corners_of(mesh, corners), solid, distance).clique(most + 1);
  return clique == 0 ? 0 : clique - 1;
}

}  // namespace kaboum::bcd
