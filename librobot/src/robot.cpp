// What a robot has to be: joints and shapes whose numbers mean something.

#include <kaboum/base/error.h>
#include <kaboum/robot/robot.h>

#include <cmath>
#include <set>

namespace kaboum::robot {
namespace {

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorCode::InvalidInput, what); }

bool is_pose(const Transform& t) {
  return t.translation.allFinite() && t.linear.allFinite() &&
         (t.linear * t.linear.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-12 &&
         t.linear.determinant() > 0;
}

void require_valid(const Robot& robot, const Joint& joint, std::size_t place) {
  const std::string name = "joint '" + joint.name + "': ";
  if (joint.parent > place) fail(name + "its parent does not come before it");
  if (!is_pose(joint.origin)) fail(name + "its origin is not finite or not a rotation");
  if (joint.type == JointType::Fixed) return;
  if (!(std::abs(joint.axis.norm() - 1) < 1e-12)) fail(name + "its axis is not a direction");
  if (joint.variable >= robot.variables.size()) fail(name + "its variable does not exist");
  if (!std::isfinite(joint.multiplier) || !std::isfinite(joint.offset))
    fail(name + "it mimics by numbers that are not finite");
}

void require_valid(const Link& link, const Geometry& g) {
  const std::string name = "link '" + link.name + "': ";
  if (!is_pose(g.origin)) fail(name + "the origin of a shape is not finite or not a rotation");
  if (!g.size.allFinite()) fail(name + "the size of a shape is not finite");
  if (g.shape == Geometry::Shape::Mesh) {
    if (g.mesh.empty()) fail(name + "a mesh without file name");
    if ((g.size.array() == 0).any()) fail(name + "a mesh scaled by 0");
  } else if (!(g.size.array() >= 0).all()) {
    fail(name + "a " + describe(g) + " whose size is negative");
  }
}

}  // namespace

std::optional<std::uint32_t> Robot::find_link(std::string_view link_name) const {
  for (std::uint32_t i = 0; i < links.size(); ++i)
    if (links[i].name == link_name) return i;
  return std::nullopt;
}

void require_valid(const Robot& robot) {
  if (robot.links.empty() || robot.joints.size() + 1 != robot.links.size())
    fail("a robot needs one joint per link but the root");
  for (std::size_t j = 0; j < robot.joints.size(); ++j) require_valid(robot, robot.joints[j], j);
  std::set<std::string_view> names;
  for (const Link& link : robot.links) {
    if (!names.insert(link.name).second) fail("two links are called '" + link.name + "'");
    for (const Geometry& g : link.collision) require_valid(link, g);
    for (const Geometry& g : link.visual) require_valid(link, g);
  }
  for (const Variable& v : robot.variables)
    if ((v.lower && !std::isfinite(*v.lower)) || (v.upper && !std::isfinite(*v.upper)) ||
        (v.lower && v.upper && *v.lower > *v.upper))
      fail("joint '" + v.name + "': its limits are not finite or not in order");
}

}  // namespace kaboum::robot
