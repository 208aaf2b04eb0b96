// Faces that things stand on, and bases that they stand by.
#include "standing.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace kaboum::manipulation {
namespace {

/// A base is at least so many epsilons of its support wide: slots up to 2 wide may be closed in
/// sets.
constexpr double kBridges = 4;
/// Seen from above, so near points count as one. [m]
constexpr double kOnePoint = 1e-9;
/// How far from level a support may lie. [1 - cosine]
constexpr double kLevel = 1e-9;

/// Seen from above.
geom::Polygon2 outline_of(const std::vector<geom::Vec3>& points) {
  std::vector<geom::Vec2> seen;
  seen.reserve(points.size());
  for (const geom::Vec3& p : points) seen.emplace_back(p.head<2>());
  return geom::convex_hull(std::move(seen));
}

double height_of(const geom::ConvexBody& body) {
  double height = -std::numeric_limits<double>::infinity();
  for (const geom::Vec3& v : body.core.vertices) height = std::max(height, v.z());
  return height;
}

std::vector<geom::Vec3> highest(const geom::ConvexBody& body) {
  const double height = height_of(body);
  std::vector<geom::Vec3> out;
  std::ranges::copy_if(body.core.vertices, std::back_inserter(out),
                       [&](const geom::Vec3& v) { return v.z() >= height - kFlat; });
  return out;
}

/// Corners of what of a body is no higher than `close` above a point, turned as the body stands.
/// Of a rounded body: of its core, lowered by the radius.
std::vector<geom::Vec3> low_corners(const geom::ConvexBody& body, const Eigen::Matrix3d& stands,
                                    const geom::Vec3& point, double close) {
  std::vector<geom::Vec3> all, low;
  all.reserve(body.core.vertices.size());
  for (const geom::Vec3& v : body.core.vertices)
    all.emplace_back(stands * (v - point) - body.radius * geom::Vec3::UnitZ());
  std::ranges::copy_if(all, std::back_inserter(low),
                       [&](const geom::Vec3& v) { return v.z() <= close; });
  const auto cut = [&](const geom::Vec3& a, const geom::Vec3& b) {
    if (a.z() > b.z() || a.z() > close || b.z() <= close) return;
    const geom::Vec3 p = a + (close - a.z()) / (b.z() - a.z()) * (b - a);
    if ((p - a).head<2>().norm() > kOnePoint) low.push_back(p);
  };
  if (all.size() == 2) {
    cut(all[0], all[1]);
    cut(all[1], all[0]);
  }
  // Each edge is in two triangles, once in each direction: it is cut on its way up.
  for (const auto& t : body.core.triangles)
    for (std::size_t k = 0; k < 3; ++k) cut(all[t[k]], all[t[(k + 1) % 3]]);
  return low;
}

}  // namespace

UpperFace::UpperFace(const geom::ConvexBody& body, double inside)
    : inside_(inside),
      height_(height_of(body) + body.radius),
      low_(geom::Vec3::Constant(std::numeric_limits<double>::infinity())),
      high_(-low_),
      outline_(outline_of(highest(body))) {
  for (const geom::Vec3& v : highest(body)) {
    low_ = low_.cwiseMin(v);
    high_ = high_.cwiseMax(v);
  }
}

geom::Vec3 UpperFace::at(double x, double y) const {
  return {low_.x() + x * (high_.x() - low_.x()), low_.y() + y * (high_.y() - low_.y()), height_};
}

bool is_level(const Eigen::Matrix3d& turned) { return turned(2, 2) >= 1 - kLevel; }

std::vector<geom::Vec3> base_of(const world::Object& object, const Eigen::Matrix3d& stands,
                                const geom::Vec3& point, double close) {
  std::vector<geom::Vec3> base;
  for (std::size_t i = 0; i < object.outer.size(); ++i) {
    const geom::ConvexBody& body = object.outer.body(i);
    const std::vector<geom::Vec3> corners = low_corners(body, stands, point, close);
    base.insert(base.end(), corners.begin(), corners.end());
    if (body.radius == 0) continue;
    // At `close` balls round points of the core are no wider than that round its lowest one:
    // squares hold them.
    double above = 0;
    for (const geom::Vec3& v : corners) above = std::max(above, close - v.z());
    above = std::min(above, body.radius);
    const double reach = std::sqrt(above * (2 * body.radius - above));
    for (const geom::Vec3& v : corners)
      for (const double x : {-reach, reach})
        for (const double y : {-reach, reach}) base.emplace_back(v + geom::Vec3(x, y, 0));
  }
  return base;
}

geom::Polygon2 foot_of(const world::Object& object, const Eigen::Matrix3d& stands,
                       const geom::Vec3& point) {
  std::vector<geom::Vec3> foot;
  for (std::size_t i = 0; i < object.outer.size(); ++i)
    std::ranges::copy(low_corners(object.outer.body(i), stands, point, kFlat),
                      std::back_inserter(foot));
  return outline_of(foot);
}

/// Bodies reach beyond the support by epsilon, and close slots twice as wide: a base has to bridge
/// these. The solid's own is narrower than its set's by up to its epsilon on both sides.
bool bridges_slots(const geom::Polygon2& foot, const world::Object& object,
                   const world::Object& support) {
  return geom::width_of(foot) - 2 * object.outer.epsilon() > kBridges * support.outer.epsilon();
}

const world::Feature& feature_named(const world::Object& object, const std::string& name,
                                    world::Feature::Kind kind, const char* needs) {
  for (const world::Feature& feature : object.features)
    if (feature.name == name && feature.kind == kind) return feature;
  throw Error(ErrorCode::InvalidInput,
              "object '" + object.name + "' of the scene has no " +
                  (kind == world::Feature::Kind::Point ? "point" : "plane") + " '" + name +
                  "' among its features, which " + needs + " needs");
}

}  // namespace kaboum::manipulation
