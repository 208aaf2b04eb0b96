// Bodies in the frame of their link, where scale and pose are rounded, as float32 polytopes that
// contain them and what rounding may have moved them by, or (inner ones) lie in them in spite of
// it.

#include "link_polytopes.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/convex_polytope.h>
#include <kaboum/geom/float32.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/holding.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace kaboum::certify {
namespace {

using geom::Vec3;

/// Corners of the cubes round the points that contain the balls of the radius, rounding included:
/// in one coordinate p ± half errs by less than 2^-52 of the largest.
std::vector<Vec3> cubes(const std::vector<Vec3>& points, double radius) {
  double largest = radius;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff() + radius);
  const double half = radius * (1 + 0x1p-50) + 0x1p-51 * largest;
  std::vector<Vec3> corners;
  corners.reserve(8 * points.size());
  for (const Vec3& p : points)
    for (int corner = 0; corner < 8; ++corner)
      corners.emplace_back(p + Vec3((corner & 1) != 0 ? half : -half,
                                    (corner & 2) != 0 ? half : -half,
                                    (corner & 4) != 0 ? half : -half));
  return corners;
}

bool contains(const geom::Mesh& hull, const std::vector<Vec3>& points) {
  const geom::ConvexPolytope polytope(hull);
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return polytope.contains(p); });
}

/// About its middle the hull is scaled by 1 + share, so that planes move outwards by `distance`, or
/// inwards by what is below 0, all rounding apart.
struct Scaling {
  Vec3 middle = Vec3::Zero();
  double share = 0, extent = 0;  ///< extent: of the hull from the middle [length]
};

Scaling scaling_by(const geom::Mesh& hull, double distance) {
  Scaling out;
  for (const Vec3& v : hull.vertices) out.middle += v / static_cast<double>(hull.vertices.size());
  double height = std::numeric_limits<double>::infinity();
  for (const Vec3& v : hull.vertices) out.extent = std::max(out.extent, (v - out.middle).norm());
  for (const geom::Triangle& t : hull.triangles) {
    const Vec3& a = hull.vertices[t[0]];
    const Vec3 n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
    if (n.norm() > 0) height = std::min(height, n.dot(a - out.middle) / n.norm());
  }
  out.share = distance / height;
  return out;
}

/// Rounded to float32.
std::optional<geom::Mesh> scaled(const geom::Mesh& hull, const Scaling& by) {
  std::vector<Vec3> points;
  for (const Vec3& v : hull.vertices)
    points.push_back(geom::to_float32(Vec3(by.middle + (1 + by.share) * (v - by.middle))));
  return geom::convex_hull(points);
}

/// nullopt where a vertex would move by more than `most`, the body being thin.
std::optional<geom::Mesh> enlarged(const geom::Mesh& hull, double distance, double most) {
  const Scaling by = scaling_by(hull, distance);
  if (!(by.share > 0 && by.share * by.extent <= most)) return std::nullopt;
  return scaled(hull, by);
}

/// nullopt where the body is thinner than four times that.
std::optional<geom::Mesh> shrunk(const geom::Mesh& hull, double distance) {
  const Scaling by = scaling_by(hull, -distance);
  if (!(by.share < 0 && by.share > -0.5)) return std::nullopt;
  return scaled(hull, by);
}

/// The hull of the points moved outwards by a float32 spacing, then rounded by half of one at most.
geom::Mesh rounded_outwards(const std::vector<Vec3>& corners, double spacing) {
  std::vector<Vec3> points;
  for (const Vec3& p : cubes(corners, spacing)) points.push_back(geom::to_float32(p));
  std::optional<geom::Mesh> hull = geom::convex_hull(points);
  ensure(hull.has_value(), "cubes have no hull");
  return *std::move(hull);
}

}  // namespace

LinkPolytopes link_polytopes(const std::vector<robot::LinkBody>& bodies, double allowance) {
  LinkPolytopes out;
  for (const robot::LinkBody& body : bodies) {
    std::vector<Vec3> points;
    geom::Box3 box;
    double moved = 0;
    for (const Vec3& p : body.points) {
      points.push_back(geom::to_float32(p));
      box.extend(p);
      moved = std::max(moved, (points.back() - p).norm());
    }
    std::optional<geom::Mesh> hull = geom::convex_hull(points);
    if (moved > 0 || body.margin > 0) {
      const std::vector<Vec3> held = cubes(body.points, body.margin);
      double largest = 0;
      for (const Vec3& p : held) largest = std::max(largest, p.cwiseAbs().maxCoeff());
      const double spacing = geom::float32_spacing(largest);
      // To the cubes' corners, and twice the rounding of a vertex.
      const double distance = 2 * allowance * (body.margin + moved + 2 * spacing);
      if (hull) hull = enlarged(*hull, distance, 1e-4 * box.diagonal());
      if (!hull || !contains(*hull, held)) hull = rounded_outwards(held, allowance * spacing);
      double excess = 0;  // of the polytope from the points of the body
      for (const Vec3& v : hull->vertices) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& p : body.points) nearest = std::min(nearest, (v - p).norm());
        excess = std::max(excess, nearest);
      }
      out.beyond = std::max(out.beyond, (excess + body.margin) * (1 + 0x1p-40));
    }
    ensure(hull.has_value(), "a body of a link is flat");
    out.set.bodies.push_back({body.name, *std::move(hull)});
  }
  return out;
}

std::string objection(const geom::ConvexSet& set, const std::vector<robot::LinkBody>& bodies) {
  if (geom::margin_of(set) != 0.0) return "a radius is stated";
  std::vector<verify::RoundedHull> held;
  held.reserve(bodies.size());
  for (const robot::LinkBody& body : bodies) held.push_back({body.points, body.margin});
  const verify::Claim claim = verify::verify_holding(set, held);
  return claim.answer == verify::Answer::Verified ? "" : claim.reason;
}

std::optional<InnerPolytopes> inner_polytopes(const std::vector<robot::LinkBody>& bodies,
                                              double allowance) {
  InnerPolytopes out;
  for (const robot::LinkBody& body : bodies) {
    std::optional<geom::Mesh> hull = geom::convex_hull(body.points);
    double moved = 0, largest = 0;
    for (const Vec3& p : body.points) {
      moved = std::max(moved, (geom::to_float32(p) - p).norm());
      largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    if (moved > 0 || body.margin > 0) {
      out.is_exact = false;
      // As for outer ones.
      const double distance =
          2 * allowance * (body.margin + moved + 2 * geom::float32_spacing(largest));
      if (hull) hull = shrunk(*hull, distance);
    }
    if (!hull) return std::nullopt;
    out.set.bodies.push_back({body.name, *std::move(hull)});
  }
  return out;
}

std::string inner_objection(const geom::ConvexSet& set,
                            const std::vector<robot::LinkBody>& bodies) {
  if (geom::margin_of(set) != 0.0) return "a radius is stated";
  if (set.bodies.size() != bodies.size())
    return std::to_string(set.bodies.size()) + " polytopes for " + std::to_string(bodies.size());
  const verify::Convexity convexity = verify::verify_convexity(set);
  if (convexity.convex.answer != verify::Answer::Verified) return convexity.convex.reason;
  geom::ConvexSet around;
  std::vector<verify::RoundedHull> held;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    std::optional<geom::Mesh> hull = geom::convex_hull(bodies[i].points);
    if (!hull) return "body " + bodies[i].name + " is flat";
    around.bodies.push_back({bodies[i].name, *std::move(hull)});
    held.push_back({set.bodies[i].core.vertices, bodies[i].margin});
  }
  const verify::Claim claim = verify::verify_holding(around, held);
  return claim.answer == verify::Answer::Verified ? "" : claim.reason;
}

}  // namespace kaboum::certify
