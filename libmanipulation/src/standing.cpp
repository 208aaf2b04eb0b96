// Faces that things stand on, and bases that they stand by.
#include "standing.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <limits>

namespace kaboum::manipulation {
namespace {

/// A base is at least so many epsilons of its support wide: slots up to 2 wide may be closed in
/// sets.
constexpr double kBridges = 4;
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
  for (std::size_t i = 0; i < object.outer.size(); ++i)
    for (const geom::Vec3& v : object.outer.body(i).core.vertices) {
      const geom::Vec3 at = stands * (v - point);
      if (at.z() <= close + object.outer.body(i).radius) base.push_back(at);
    }
  return base;
}

/// Bodies reach beyond the support by epsilon, and close slots twice as wide: a base has to bridge
/// these.
bool bridges_slots(const std::vector<geom::Vec3>& base, const world::Object& support) {
  if (base.empty()) return false;
  geom::Vec3 low = base.front(), high = base.front();
  for (const geom::Vec3& v : base) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (high - low).head<2>().minCoeff() > kBridges * support.outer.epsilon();
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
