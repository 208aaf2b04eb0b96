// Capsules and boxes of robots in the formats of engines.
#include <kaboum/robot_folder/simple_shapes.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision_urdf.h"

namespace kaboum::robot_folder {
namespace {

using geom::Vec3;
using Kind = SimpleShape::Kind;

/// Of lengths: more than what a dozen operations and a rotation from its angles err by, which is
/// 300 · 2^-53 (docs/algorithms/capsules-and-boxes.md, "Robots").
constexpr double kPoseRounding = 0x1p-44;

/// Angles whose rotation is about that of the matrix.
Vec3 rpy_of(const Eigen::Matrix3d& m) {
  return {std::atan2(m(2, 1), m(2, 2)), std::asin(std::clamp(-m(2, 0), -1.0, 1.0)),
          std::atan2(m(1, 0), m(0, 0))};
}

double largest_of(const std::vector<Vec3>& points) {
  double out = 0;
  for (const Vec3& p : points) out = std::max(out, p.norm());
  return out;
}

SimpleShape sphere_of(const robot::LinkBody& body) {
  const double error = kPoseRounding * (body.points[0].norm() + body.margin);
  return {Kind::Sphere, body.link, body.points[0], Vec3::Zero(), Vec3(body.margin + error, 0, 0)};
}

/// The capsule whose axis is along the rotation of angles, round balls of the margin about the two
/// points: both are measured along it, however well the angles fit.
SimpleShape capsule_of(const robot::LinkBody& body) {
  const Vec3 along = body.points[1] - body.points[0];
  // The angle from z; its cosine would not tell small ones apart.
  const Vec3 rpy(0, std::atan2(std::hypot(along.x(), along.y()), along.z()),
                 std::atan2(along.y(), along.x()));
  const Eigen::Matrix3d turn = robot::rotation_from_rpy(rpy.x(), rpy.y(), rpy.z());
  const Vec3 a = turn.transpose() * body.points[0], b = turn.transpose() * body.points[1];
  const double length = std::abs(b.z() - a.z()),
               beside = 0.5 * std::hypot(b.x() - a.x(), b.y() - a.y());
  const double error = kPoseRounding * (largest_of(body.points) + length + body.margin);
  return {Kind::Capsule, body.link, turn * (0.5 * (a + b)), rpy,
          Vec3(body.margin + beside + error, length, 0)};
}

/// The box along the rotation of angles, round balls of the margin about the points.
SimpleShape box_along(const robot::LinkBody& body, const Vec3& rpy) {
  const Eigen::Matrix3d turn = robot::rotation_from_rpy(rpy.x(), rpy.y(), rpy.z());
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : body.points) {
    const Vec3 q = turn.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const double error = kPoseRounding * (largest_of(body.points) + body.margin);
  return {Kind::Box, body.link, turn * (0.5 * (low + high)), rpy,
          high - low + Vec3::Constant(2 * (body.margin + error))};
}

SimpleShape box_of(const robot::LinkBody& body) {
  const std::vector<Vec3>& p = body.points;
  SimpleShape best = box_along(body, Vec3::Zero());
  for (std::size_t i = 1; i < p.size(); ++i)
    for (std::size_t k = 1; k < p.size(); ++k) {
      if (i == k) continue;
      Eigen::Matrix3d axes;
      axes.col(0) = (p[i] - p[0]).normalized();
      const Vec3 other = p[k] - p[0] - (p[k] - p[0]).dot(axes.col(0)) * axes.col(0);
      axes.col(1) = other.normalized();
      axes.col(2) = axes.col(0).cross(axes.col(1));
      if (!axes.allFinite() || !(axes.determinant() > 0.9)) continue;
      const SimpleShape one = box_along(body, rpy_of(axes));
      if (one.size.prod() < best.size.prod() * (1 - 1e-9)) best = one;
    }
  return best;
}

/// How far the box reaches beyond the body at most, by its corners.
double beyond_of(const SimpleShape& box, const robot::LinkBody& body) {
  const Eigen::Matrix3d turn = robot::rotation_from_rpy(box.rpy.x(), box.rpy.y(), box.rpy.z());
  double out = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 half = 0.5 * box.size;
    const Vec3 corner = box.center + turn * Vec3((i & 1) != 0 ? half.x() : -half.x(),
                                                 (i & 2) != 0 ? half.y() : -half.y(),
                                                 (i & 4) != 0 ? half.z() : -half.z());
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& p : body.points) nearest = std::min(nearest, (p - corner).norm());
    out = std::max(out, nearest);
  }
  return out * (1 + 1e-12);
}

void add_shape(tinyxml2::XMLElement& link, const SimpleShape& shape) {
  switch (shape.kind) {
    case Kind::Box:
      add_collision(link, shape.center, shape.rpy)
          ->InsertNewChildElement("box")
          ->SetAttribute("size", decimals(shape.size).c_str());
      return;
    case Kind::Sphere:
      add_collision(link, shape.center, shape.rpy)
          ->InsertNewChildElement("sphere")
          ->SetAttribute("radius", decimal(shape.size.x()).c_str());
      return;
    case Kind::Capsule:
      break;
  }
  const std::string radius = decimal(shape.size.x());
  tinyxml2::XMLElement* cylinder =
      add_collision(link, shape.center, shape.rpy)->InsertNewChildElement("cylinder");
  cylinder->SetAttribute("radius", radius.c_str());
  cylinder->SetAttribute("length", decimal(shape.size.y()).c_str());
  const Eigen::Matrix3d turn =
      robot::rotation_from_rpy(shape.rpy.x(), shape.rpy.y(), shape.rpy.z());
  for (const double end : {-0.5, 0.5})
    add_collision(link, shape.center + end * shape.size.y() * turn.col(2), Vec3::Zero())
        ->InsertNewChildElement("sphere")
        ->SetAttribute("radius", radius.c_str());
}

}  // namespace

SimpleShapes simple_shapes(const std::vector<robot::LinkBody>& bodies) {
  SimpleShapes out;
  for (const robot::LinkBody& body : bodies) {
    if (body.points.size() > 2) {
      out.shapes.push_back(box_of(body));
      out.beyond = std::max(out.beyond, beyond_of(out.shapes.back(), body));
      continue;
    }
    out.shapes.push_back(body.points.size() == 1 ? sphere_of(body) : capsule_of(body));
    out.beyond = std::max(out.beyond, out.shapes.back().size.x() - body.margin);
  }
  return out;
}

std::string urdf_of_shapes(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                           const SimpleShapes& shapes, const std::string& parameters,
                           const std::string& file) {
  const auto add = [&](tinyxml2::XMLElement& link, std::uint32_t index) {
    for (const SimpleShape& shape : shapes.shapes)
      if (shape.link == index) add_shape(link, shape);
  };
  return urdf_with(robot, bodies, add, origin_of("Spheres, capsules and boxes", robot, parameters),
                   file);
}

}  // namespace kaboum::robot_folder
