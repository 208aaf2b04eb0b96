// Points, each inside a solid or outside: exact winding numbers, distances with their rounding.
#include <kaboum/verify/points.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cell_sample.h"
#include "nearest.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

/// How far outside the box, from below; 0: inside it.
double beyond(const geom::Box3& box, const Vec3& p) {
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max({most, box.min[k] - p[k], p[k] - box.max[k]});
  return most;
}

/// How far the point sticks out, from below; 0: it does not.
class Outside {
 public:
  explicit Outside(const geom::Mesh& solid)
      : pair_(geom::Mesh{}, solid), nearest_(pair_, kOutside), box_(geom::bounding_box(solid)) {}

  [[nodiscard]] bool closed() const { return pair_.closed(kOutside); }
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
  MeshPair pair_;
  NearestTriangle nearest_;
  geom::Box3 box_;
};

}  // namespace

PointClaim verify_points(const PointQuestion& q, const geom::Mesh& solid, double margin) {
  PointClaim out;
  out.points = q.points.size();
  out.rounding = q.rounding;
  if (q.points.empty()) {
    out.reason = "there are no points";
    return out;
  }
  const Outside outside(solid);
  if (!outside.closed()) {
    out.reason = "the outer mesh is not closed";
    return out;
  }
  // A point is wrong by at most √3 times what its coordinates are.
  const double allowed = (margin + 1.8 * q.rounding) * (1 + 0x1p-50);
  const bool finite = std::ranges::all_of(q.points, [](const Vec3& p) { return p.allFinite(); });
  if (!finite || !std::isfinite(allowed)) {
    out.reason = "numbers are not finite";
    return out;
  }
  std::vector<double> depths(q.points.size());
  verify::parallel_for(std::size_t{0}, q.points.size(),
                       [&](std::size_t i) { depths[i] = outside.depth(q.points[i]); });
  std::set<std::uint32_t> faces;
  double deepest = allowed;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!(depths[i] > allowed)) continue;
    ++out.outside;
    if (i < q.of_face.size()) faces.insert(q.of_face[i]);
    if (!(depths[i] > deepest)) continue;
    deepest = depths[i];
    out.at = q.points[i];
    out.face = i < q.of_face.size() ? q.of_face[i] : 0;
  }
  out.faces = faces.size();
  out.farthest = out.outside > 0 ? (deepest - allowed) * (1 - 0x1p-50) : 0;
  out.answer = out.outside > 0 ? Answer::Refuted : Answer::Verified;
  return out;
}

}  // namespace kaboum::verify
