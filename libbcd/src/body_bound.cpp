// A number of bodies that is certainly too small: of more points than bodies, two are in one.
// docs/algorithms/convex-decomposition.md, "More bodies".

#include "body_bound.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

namespace kaboum::bcd {
namespace {

/// Corners looked at: so many times the bodies, between these.
constexpr std::size_t kCornersPerBody = 6, kFewestCorners = 64, kMostCorners = 320;
/// Shares of the way between two corners that are looked at: the middle first, mostly the farthest.
constexpr std::array<double, 5> kOnTheWay{0.5, 0.3, 0.7, 0.15, 0.85};
/// Corners that the search begins with, in turn.
constexpr std::size_t kStarts = 12;
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

/// Which corners no body within the distance contains both of: guessed for all pairs, decided for
/// those that matter.
class Apart {
 public:
  Apart(std::vector<Vec3> corners, const SolidField& solid, double distance)
      : corners_(std::move(corners)),
        solid_(solid),
        least_((1 + kRoundedAway) * distance + kRoundedAway * solid.diagonal()),
        guess_(corners_.size() * corners_.size(), 0) {
    const std::size_t n = corners_.size();
    parallel_for(std::size_t{0}, n, [&](std::size_t i) {
      for (std::size_t j = 0; j < i; ++j)
        guess_[i * n + j] = any_on_the_way(i, j, [&](const Vec3& p) { return seems_far(p); });
    });
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) guess_[j * n + i] = guess_[i * n + j];
  }

  /// The most corners found that are all apart from each other, up to `most`.
  [[nodiscard]] std::size_t clique(std::size_t most) const {
    std::size_t best = clique_from({}, most);
    for (std::size_t start = 0; start < kStarts && best < most; ++start)
      best = std::max(best, clique_from({start * corners_.size() / kStarts}, most));
    return best;
  }

 private:
  /// Corners apart from each other, the first one if it is given: each time the one that leaves
  /// most of the others is added.
  [[nodiscard]] std::size_t clique_from(std::optional<std::size_t> first, std::size_t most) const {
    std::vector<std::size_t> left(corners_.size()), chosen, kept;
    std::iota(left.begin(), left.end(), std::size_t{0});
    const auto choose = [&](std::size_t next) {
      chosen.push_back(next);
      std::erase_if(left, [&](std::size_t j) { return !seem_apart(next, j); });
    };
    if (first) choose(*first);
    while (!left.empty() && chosen.size() < most) {
      kept.assign(left.size(), 0);
      parallel_for(std::size_t{0}, left.size(), [&](std::size_t a) {
        kept[a] = static_cast<std::size_t>(std::count_if(
            left.begin(), left.end(), [&](std::size_t j) { return seem_apart(left[a], j); }));
      });
      const auto best = std::max_element(kept.begin(), kept.end()) - kept.begin();
      const std::size_t next = left[static_cast<std::size_t>(best)];
      const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](std::size_t i) {
        return any_on_the_way(i, next, [&](const Vec3& p) { return is_far(p); });
      });
      if (apart) {
        choose(next);
      } else {
        left.erase(left.begin() + best);
      }
    }
    return chosen.size();
  }

  [[nodiscard]] bool seem_apart(std::size_t i, std::size_t j) const {
    return guess_[i * corners_.size() + j] != 0;
  }
  /// True if one of the points looked at on the way between two corners is far from the solid.
  template <class Far>
  [[nodiscard]] bool any_on_the_way(std::size_t i, std::size_t j, Far&& far) const {
    const Vec3 &a = corners_[i], &b = corners_[j];
    return (b - a).norm() > 2 * least_ &&
           std::any_of(kOnTheWay.begin(), kOnTheWay.end(), [&](double t) {
             solid_.work().add(kPointWork);
             return far(a + t * (b - a));
           });
  }
  [[nodiscard]] bool seems_far(const Vec3& p) const {
    return solid_.field(p) > 0 && off_surface(p);
  }
  [[nodiscard]] bool is_far(const Vec3& p) const { return off_surface(p) && !solid_.contains(p); }
  [[nodiscard]] bool off_surface(const Vec3& p) const {
    return solid_.surface().within(p, least_) == geom::TriangleSearch::kNone;
  }

  std::vector<Vec3> corners_;
  const SolidField& solid_;
  double least_;
  std::vector<char> guess_;
};

}  // namespace

std::size_t too_few_bodies(const Mesh& mesh, const SolidField& solid, double distance,
                           std::size_t most) {
  const std::size_t corners = std::clamp(kCornersPerBody * most, kFewestCorners, kMostCorners);
  return Apart(corners_of(mesh, corners), solid, distance).clique(most + 1) - 1;
}

}  // namespace kaboum::bcd
