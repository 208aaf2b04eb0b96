// Points, each inside a solid or outside: exact winding numbers, distances with their rounding.
#include <kaboum/verify/points.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "outside.h"
#include "parallel.h"

namespace kaboum::verify {

PointClaim verify_points(const PointQuestion& q, const geom::Mesh& solid, double margin) {
  return verify_points(q, Outside(solid), margin);
}

PointClaim verify_points(const PointQuestion& q, const Outside& outside, double margin) {
  PointClaim out;
  out.points = q.points.size();
  out.rounding = q.rounding;
  if (q.points.empty()) {
    out.reason = "there are no points";
    return out;
  }
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
