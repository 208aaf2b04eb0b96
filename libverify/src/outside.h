#pragma once

#include <kaboum/verify/points.h>

#include <algorithm>
#include <optional>

#include "cell_sample.h"
#include "nearest.h"

namespace kaboum::verify {

/// The outside of a solid, ready for many points.
class Outside {
 public:
  explicit Outside(const geom::Mesh& solid)
      : pair_(geom::Mesh{}, solid), nearest_(pair_, kOutside), box_(geom::bounding_box(solid)) {}

  [[nodiscard]] bool closed() const { return pair_.closed(kOutside); }
  /// How far the point sticks out, from below; 0: it does not. [length]
  [[nodiscard]] double depth(const Vec3& point) const {
    const double past_box = beyond(box_, point);
    const Vec3 p = point * pair_.scale();
    if (!p.allFinite()) return past_box;
    // What is beyond the box is outside.
    if (!(past_box > 0)) {
      const std::optional<int> winding = winding_at(pair_, kOutside, p);
      if (!winding || *winding >= 1) return 0;
    }
    const double largest = std::max(pair_.largest_coordinate(), p.cwiseAbs().maxCoeff());
    const double distance = nearest_.distance(p) - rounding_of_distances(largest);
    return std::max({0.0, past_box, pair_.length_outside(distance)});
  }

 private:
  /// How far outside the box, from below; 0: inside it.
  static double beyond(const geom::Box3& box, const Vec3& p) {
    double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max({most, box.min[k] - p[k], p[k] - box.max[k]});
    return most;
  }

  MeshPair pair_;
  NearestTriangle nearest_;
  geom::Box3 box_;
};

/// As verify_points with the solid's mesh.
PointClaim verify_points(const PointQuestion& q, const Outside& outside, double margin);

}  // namespace kaboum::verify
