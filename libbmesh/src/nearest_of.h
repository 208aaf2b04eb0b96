#pragma once

#include <kaboum/geom/four_triangles.h>

#include <bit>
#include <limits>
#include <span>
#include <vector>

#include "change.h"
#include "closest_triangle.h"

namespace kaboum::bmesh {

/// The nearest of a few triangles, for many points: for costs, never for certificates.
class NearestOf {
 public:
  /// The triangles must outlive this object.
  explicit NearestOf(std::span<const NewTriangle> triangles) : triangles_(triangles) {}

  /// Squared distance of p from the nearest triangle, or from one that is within √enough; infinite
  /// where there are none.
  /// @param which  where it is looked for first; receives where that is.
  double squared(const Vec3& p, std::size_t& which, double enough = 0) {
    if (triangles_.empty()) return std::numeric_limits<double>::infinity();
    const std::size_t first = which;
    double best = squared_distance(p, triangles_[first].corner);
    if (!(best > enough) || triangles_.size() == 1) return best;
    prepare();
    float cutoff = frame_.cutoff(best);
    const Eigen::Vector3f x = frame_(p);
    std::size_t f = first / 4;
    for (std::size_t i = 0; i < fours_.size() && best > enough; ++i, ++f) {
      if (f == fours_.size()) f = 0;
      const geom::Float4 bound = fours_[f].at_least(x);
      for (unsigned near = geom::bits_below(bound, cutoff); near != 0; near &= near - 1) {
        const std::size_t k = 4 * f + static_cast<std::size_t>(std::countr_zero(near));
        if (k >= triangles_.size()) break;
        if (!(bound[k % 4] < cutoff) || k == first) continue;
        const double d = squared_distance(p, triangles_[k].corner);
        if (d >= best) continue;
        best = d;
        cutoff = frame_.cutoff(best);
        which = k;
      }
    }
    return best;
  }

  /// Sets keep[i] to whether triangle i may be within √enough of p: those that are, are kept, but
  /// for rounding. Those that keep[i] rules out already are not looked at.
  void within(const Vec3& p, double enough, std::span<char> keep) {
    prepare();
    const float cutoff = frame_.cutoff(enough);
    const Eigen::Vector3f x = frame_(p);
    for (std::size_t f = 0; f < fours_.size(); ++f) {
      const geom::Float4 bound = fours_[f].at_least(x);
      const std::size_t end = std::min(triangles_.size(), 4 * f + 4);
      for (std::size_t k = 4 * f; k < end; ++k)
        keep[k] = static_cast<char>(keep[k] & static_cast<char>(bound[k % 4] <= cutoff));
    }
  }

  /// About the nanoseconds that one of the calls above takes.
  [[nodiscard]] std::uint64_t steps() const { return 15 + 10 * ((triangles_.size() + 3) / 4); }

 private:
  /// Bounds of the triangles, when they are first asked for: where the first triangle looked at
  /// will do, they are not needed.
  void prepare() {
    if (!fours_.empty()) return;
    geom::Box3 box;
    for (const NewTriangle& t : triangles_)
      for (const Vec3& p : t.corner) box.extend(p);
    frame_ = geom::UnitFrame(box);
    fours_.resize((triangles_.size() + 3) / 4);
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      fours_[i / 4].put(static_cast<int>(i % 4), triangles_[i].corner, frame_);
  }

  std::span<const NewTriangle> triangles_;
  geom::UnitFrame frame_;
  std::vector<geom::FourTriangles> fours_;
};

}  // namespace kaboum::bmesh
