// Faces that things stand on, and bases that they stand by.
#include "standing.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace kaboum::manipulation {
namespace {

/// A base is at least so many epsilons of its support wide: slots up to 2 wide may be closed in
/// sets.
constexpr double kBridges = 4;
/// Seen from above, so near points count as one. [m]
constexpr double kOnePoint = 1e-9;
/// How far from level a support may lie. [1 - cosine]
constexpr double kLevel = 1e-9;

/// Twice the area of the triangle; above 0: p is on the left of the way from a to b.
double turn(const geom::Vec3& a, const geom::Vec3& b, const geom::Vec3& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
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

/// Andrew's chains.
Outline::Outline(std::vector<geom::Vec3> points) {
  std::ranges::sort(points, [](const geom::Vec3& a, const geom::Vec3& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  const auto chain = [&](const geom::Vec3& p, std::size_t from) {
    while (corners_.size() >= from + 2 &&
           turn(corners_[corners_.size() - 2], corners_.back(), p) <= 0)
      corners_.pop_back();
    corners_.push_back(p);
  };
  for (const geom::Vec3& p : points) chain(p, 0);
  const std::size_t lower = corners_.empty() ? 0 : corners_.size() - 1;
  for (auto p = points.rbegin(); p != points.rend(); ++p) chain(*p, lower);
  if (!corners_.empty()) corners_.pop_back();
}

bool Outline::holds(const geom::Vec3& p, double inside) const {
  if (corners_.size() < 3) return false;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const geom::Vec3 &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
    if (turn(a, b, p) < inside * (b - a).head<2>().norm()) return false;
  }
  return true;
}

/// It is least across one of the sides.
double Outline::width() const {
  if (corners_.size() < 3) return 0;
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const geom::Vec3 &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
    double low = 0, high = 0;
    for (const geom::Vec3& p : corners_) {
      low = std::min(low, turn(a, b, p));
      high = std::max(high, turn(a, b, p));
    }
    out = std::min(out, (high - low) / (b - a).head<2>().norm());
  }
  return out;
}

/// Cut by one side of the other after the other (Sutherland and Hodgman).
Outline Outline::common_with(const Outline& other) const {
  if (corners_.size() < 3 || other.corners_.size() < 3) return Outline({});
  std::vector<geom::Vec3> left = corners_;
  for (std::size_t i = 0; i < other.corners_.size(); ++i) {
    const geom::Vec3 &a = other.corners_[i], &b = other.corners_[(i + 1) % other.corners_.size()];
    std::vector<geom::Vec3> kept;
    kept.reserve(left.size() + 1);
    for (std::size_t k = 0; k < left.size(); ++k) {
      const geom::Vec3 &p = left[k], &q = left[(k + 1) % left.size()];
      const double at_p = turn(a, b, p), at_q = turn(a, b, q);
      if (at_p >= 0) kept.push_back(p);
      if ((at_p < 0) != (at_q < 0)) kept.emplace_back(p + at_p / (at_p - at_q) * (q - p));
    }
    left = std::move(kept);
  }
  return Outline(std::move(left));
}

UpperFace::UpperFace(const geom::ConvexBody& body, double inside)
    : inside_(inside),
      height_(height_of(body) + body.radius),
      low_(geom::Vec3::Constant(std::numeric_limits<double>::infinity())),
      high_(-low_),
      outline_(highest(body)) {
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

Outline foot_of(const world::Object& object, const Eigen::Matrix3d& stands,
                const geom::Vec3& point) {
  std::vector<geom::Vec3> foot;
  for (std::size_t i = 0; i < object.outer.size(); ++i)
    std::ranges::copy(low_corners(object.outer.body(i), stands, point, kFlat),
                      std::back_inserter(foot));
  return Outline(std::move(foot));
}

/// Bodies reach beyond the support by epsilon, and close slots twice as wide: a base has to bridge
/// these. The solid's own is narrower than its set's by up to its epsilon on both sides.
bool bridges_slots(const Outline& foot, const world::Object& object, const world::Object& support) {
  return foot.width() - 2 * object.outer.epsilon() > kBridges * support.outer.epsilon();
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
