#pragma once

#include <kaboum/geom/convex_hull.h>
#include <kaboum/world/world.h>

#include <algorithm>
#include <random>
#include <vector>

/// Objects and hands of boxes, and what follows of boxes alone.
namespace kaboum::scene {

using geom::Transform;
using geom::Vec3;

/// A box in a frame of its own.
struct Block {
  Vec3 low, high;
  [[nodiscard]] bool holds(const Vec3& p) const {
    return (p.array() > low.array()).all() && (p.array() < high.array()).all();
  }
};

inline geom::Mesh hull_of(const Block& b, const Transform& pose) {
  std::vector<Vec3> corners;
  for (const double x : {b.low.x(), b.high.x()})
    for (const double y : {b.low.y(), b.high.y()})
      for (const double z : {b.low.z(), b.high.z()}) corners.emplace_back(pose * Vec3(x, y, z));
  return *geom::convex_hull(corners);
}

inline collide::BoundingSet set_of(const std::vector<Block>& blocks, const Transform& pose = {},
                                   double epsilon = 0) {
  std::vector<geom::ConvexBody> bodies;
  for (const Block& b : blocks) bodies.push_back({"body", hull_of(b, pose)});
  return {std::move(bodies), collide::Direction::Outer, epsilon};
}

inline const Block kPalm{{-0.3, -0.3, -0.2}, {0.3, 0.3, -0.1}};

/// A hand that turns on an arm; its tool is `ahead` of the hand's frame, whose palm ends 0.1
/// behind.
inline world::World world_with(const std::vector<Block>& blocks, double ahead,
                               const Transform& frame = {}, double epsilon = 0) {
  world::World out;
  world::RobotModel& arm = out.robots.emplace_back();
  arm.name = "arm";
  arm.kinematics.name = "arm";
  arm.kinematics.links = {{"base", {}, {}}, {"wrist", {}, {}}, {"palm", {}, {}}};
  arm.kinematics.joints = {
      {.name = "j1", .type = robot::JointType::Revolute, .parent = 0, .origin = {}},
      {.name = "fixed", .type = robot::JointType::Fixed, .parent = 1, .origin = {}}};
  arm.kinematics.variables = {{"j1", -1.0, 1.0}};
  arm.home = {0.4};
  // The base is where the object will be: it is no part of the hand.
  arm.shapes.push_back({0, set_of({{{-9, -9, -9}, {9, 9, 9}}}), {}});
  arm.shapes.push_back({2, set_of({kPalm}), {}});
  world::ToolFrame tool{"tip", 2, {}};
  tool.pose.translation = {0, 0, ahead};
  arm.tools.push_back(tool);
  out.objects.push_back({"thing", {}, set_of(blocks, frame, epsilon), {}, {}, {}, {}});
  out.attachments.resize(1);
  return out;
}

/// The frame of the tool in the object's.
inline Transform tool_in_object(const world::Grasp& grasp) {
  return {grasp.pose.linear.transpose(), -(grasp.pose.linear.transpose() * grasp.pose.translation)};
}

/// How far it is from a point within some blocks along a direction to where they end.
inline double way_out(const std::vector<Block>& blocks, const Vec3& from, const Vec3& along) {
  constexpr double kStep = 1e-4;
  double t = 0;
  const auto inside = [&](double at) {
    const Vec3 p = from + at * along;
    return std::ranges::any_of(blocks, [&](const Block& b) { return b.holds(p); });
  };
  // Two blocks that touch leave no gap that counts.
  while (inside(t) || inside(t + kStep)) t += kStep;
  return t;
}

inline Transform random_pose(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return {q.normalized().toRotationMatrix(), {normal(random), normal(random), normal(random)}};
}

}  // namespace kaboum::scene
