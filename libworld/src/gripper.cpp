// Grippers with joints and pads.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/finger_paths.h>
#include <kaboum/world/gripper.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace kaboum::world {
namespace {

/// The value of a joint in a grasp's opening.
const double* find_value(const Grasp& grasp, const std::string& joint) {
  const auto found =
      std::ranges::find(grasp.opening, joint, &std::pair<std::string, double>::first);
  return found == grasp.opening.end() ? nullptr : &found->second;
}

/// The first of the links that fixed joints connect with one, towards the base.
std::uint32_t rigid(const RobotModel& robot, std::uint32_t link) {
  while (link > 0 && robot.kinematics.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.kinematics.joints[link - 1].parent;
  return link;
}

}  // namespace

const Gripper* gripper_with_pads(const RobotModel& robot, std::uint32_t link) {
  for (const Gripper& gripper : robot.grippers)
    if (!gripper.pads.empty() && rigid(robot, robot.tools[gripper.tool].link) == rigid(robot, link))
      return &gripper;
  return nullptr;
}

std::optional<std::uint32_t> finger_joint_above(const RobotModel& robot, std::uint32_t link) {
  for (std::uint32_t at = link; at > 0; at = robot.kinematics.joints[at - 1].parent) {
    const robot::Joint& joint = robot.kinematics.joints[at - 1];
    if (joint.type == robot::JointType::Fixed) continue;
    for (const Gripper& gripper : robot.grippers)
      if (std::ranges::find(gripper.joints, joint.variable) != gripper.joints.end())
        return joint.variable;
  }
  return std::nullopt;
}

bool has_pads(const RobotModel& robot) {
  return std::ranges::any_of(robot.grippers,
                             [](const Gripper& gripper) { return !gripper.pads.empty(); });
}

bool has_finger_joints(const RobotModel& robot) {
  return std::ranges::any_of(robot.grippers,
                             [](const Gripper& gripper) { return !gripper.joints.empty(); });
}

std::optional<std::string> find_misfit(const RobotModel& robot, const Gripper& gripper,
                                       const Grasp& grasp) {
  for (const std::uint32_t variable : gripper.joints) {
    const robot::Variable& v = robot.kinematics.variables[variable];
    const double* value = find_value(grasp, v.name);
    if (value == nullptr)
      return "states no 'opening' of the joint '" + v.name + "' of the gripper '" + gripper.name +
             "' of '" + robot.name + "', which may use it";
    if ((v.lower && *value < *v.lower) || (v.upper && *value > *v.upper))
      return "opens the joint '" + v.name + "' of '" + robot.name + "' beyond its limits";
  }
  for (const std::string& pad : grasp.pads) {
    std::vector<std::string> names;
    for (const std::uint32_t link : gripper.pads)
      names.push_back(robot.kinematics.links[link].name);
    if (std::ranges::find(names, pad) == names.end())
      return "names the pad '" + pad + "', which the gripper '" + gripper.name + "' of '" +
             robot.name + "' does not have" + did_you_mean(pad, names);
  }
  return std::nullopt;
}

Attachment hold_by(const World& world, std::size_t robot, std::uint32_t link, const Transform& pose,
                   const Grasp& grasp) {
  const RobotModel& model = world.robots[robot];
  Attachment out;
  out.robot = robot;
  out.link = link;
  out.pose = pose;
  const Gripper* gripper = gripper_with_pads(model, link);
  if (gripper == nullptr) {
    for (const Gripper& other : model.grippers)
      if (model.tools[other.tool].link == link)
        out.touching.insert(out.touching.end(), other.links.begin(), other.links.end());
  } else {
    if (const auto misfit = find_misfit(model, *gripper, grasp))
      throw Error(ErrorCode::InvalidArgument, "the grasp '" + grasp.name + "' " + *misfit);
    out.link_touches = false;
    out.grasp = grasp.name;
    for (const std::uint32_t pad : gripper->pads)
      if (grasp.pads.empty() ||
          std::ranges::find(grasp.pads, model.kinematics.links[pad].name) != grasp.pads.end())
        out.touching.push_back(pad);
    for (const std::uint32_t variable : gripper->joints)
      out.fingers.push_back(
          {variable, *find_value(grasp, model.kinematics.variables[variable].name), grasp.within});
  }
  std::ranges::sort(out.touching);
  out.touching.erase(std::unique(out.touching.begin(), out.touching.end()), out.touching.end());
  return out;
}

Attachment carried_along(const Attachment& below, const Transform& relative) {
  Attachment out = below;
  out.pose = below.pose * relative;
  if (!below.link_touches) out.touching.clear();
  out.grasp.clear();
  out.fingers.clear();
  return out;
}

void set_grippers(const World& world, std::size_t robot,
                  const std::vector<std::optional<Attachment>>& attachments,
                  std::vector<double>& q) {
  const RobotModel& model = world.robots[robot];
  for (const Gripper& gripper : model.grippers)
    for (const std::uint32_t variable : gripper.joints) q[variable] = model.home[variable];
  for (const auto& held : attachments)
    if (held && held->robot == robot)
      for (const FingerValue& finger : held->fingers) q[finger.variable] = finger.value;
}

void set_grippers(const World& world, WorldState& state) {
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    set_grippers(world, r, state.attachments, state.q[r]);
}

std::vector<double> with_fingers_of(const RobotModel& robot, const std::vector<double>& other,
                                    std::vector<double> q) {
  for (const Gripper& gripper : robot.grippers)
    for (const std::uint32_t variable : gripper.joints) q[variable] = other[variable];
  return q;
}

std::vector<double> finger_room(const World& world, std::size_t robot,
                                const std::vector<std::optional<Attachment>>& attachments) {
  std::vector<double> out;
  for (const auto& held : attachments) {
    if (!held || held->robot != robot) continue;
    for (const FingerValue& finger : held->fingers) {
      if (!(finger.within > 0)) continue;
      out.resize(world.robots[robot].kinematics.variables.size(), 0);
      out[finger.variable] = std::max(out[finger.variable], finger.within);
    }
  }
  return out;
}

std::vector<std::uint32_t> holding_joints(
    std::size_t robot, const std::vector<std::optional<Attachment>>& attachments) {
  std::vector<std::uint32_t> out;
  for (const auto& held : attachments)
    if (held && held->robot == robot)
      for (const FingerValue& finger : held->fingers) out.push_back(finger.variable);
  return out;
}

std::vector<double> finger_room_along(const World& world, std::size_t robot,
                                      const std::vector<std::optional<Attachment>>& attachments,
                                      std::span<const std::vector<double>> path,
                                      const std::string& what) {
  const RobotModel& model = world.robots[robot];
  std::vector<double> out = finger_room(world, robot, attachments);
  for (std::size_t o = 0; o < attachments.size(); ++o) {
    const auto& held = attachments[o];
    if (!held || held->robot != robot) continue;
    for (const FingerValue& finger : held->fingers) {
      double most = 0;
      for (std::size_t i = 0; i < path.size(); ++i) {
        const double off = std::abs(path[i].at(finger.variable) - finger.value);
        if (!(off <= finger.within))
          throw Error(ErrorCode::InvalidArgument,
                      what + (path.size() > 1 ? " " + std::to_string(i + 1) : std::string()) +
                          ": the joint '" + model.kinematics.variables[finger.variable].name +
                          "' of '" + model.name + "' is at " +
                          number_text(path[i][finger.variable]) + ", but its gripper holds '" +
                          world.objects[o].name + "' by a grasp with " + number_text(finger.value) +
                          ", which may be off by " + number_text(finger.within) + ": state " +
                          number_text(finger.value));
        most = std::max(most, off);
      }
      if (most == 0) continue;
      out.resize(model.kinematics.variables.size(), 0);
      // A place more than rounding loses.
      out[finger.variable] = (finger.within + most) * (1 + 0x1p-40);
    }
  }
  return out;
}

bool holds_by_fingers(const WorldState& state) {
  return std::ranges::any_of(state.attachments,
                             [](const auto& held) { return held && !held->fingers.empty(); });
}

std::vector<RobotPath> paths_with_fingers(const World& world, const WorldState& state,
                                          std::size_t robot, const robot::Path& path,
                                          const std::string& what) {
  std::vector<RobotPath> out{{robot, path}};
  for (std::size_t r = 0; r < state.q.size(); ++r)
    if (r != robot && !holding_joints(r, state.attachments).empty())
      out.push_back({r, robot::Path(path.size(), state.q[r])});
  bool any = false;
  for (RobotPath& one : out) {
    one.around = finger_room_along(world, one.robot, state.attachments, one.path, what);
    any = any || !one.around.empty();
  }
  if (!any) out.clear();
  return out;
}

namespace {

/// "a, b and c"
std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

}  // namespace

std::string name_pads(const World& world, const Attachment& held) {
  const RobotModel& model = world.robots[held.robot];
  std::vector<std::string> names;
  for (const std::uint32_t link : held.touching)
    names.push_back(model.name + "/" + model.kinematics.links[link].name);
  return listed(names);
}

namespace {

/// Links without pads that may touch what they hold or push.
std::vector<std::string> links_that_touch(const World& world) {
  std::set<std::pair<std::size_t, std::uint32_t>> found;
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    const RobotModel& robot = world.robots[r];
    for (const ToolFrame& tool : robot.tools)
      if (gripper_with_pads(robot, tool.link) == nullptr) found.insert({r, tool.link});
    for (const Gripper& gripper : robot.grippers)
      for (const std::uint32_t link : gripper.links) found.insert({r, link});
    for (const LinkFeature& f : robot.features)
      if (f.feature.kind == Feature::Kind::Plane && f.feature.name.starts_with("push"))
        found.insert({r, f.link});
  }
  for (const auto& held : world.attachments) {
    if (!held || !held->link_touches) continue;
    found.insert({held->robot, held->link});
    for (const std::uint32_t link : held->touching) found.insert({held->robot, link});
  }
  std::vector<std::string> out;
  out.reserve(found.size());
  for (const auto& [robot, link] : found)
    out.push_back(world.robots[robot].name + "/" + world.robots[robot].kinematics.links[link].name);
  return out;
}

}  // namespace

std::string pads_claim(const World& world) {
  std::vector<std::string> names;
  for (const RobotModel& robot : world.robots)
    for (const Gripper& gripper : robot.grippers)
      for (const std::uint32_t link : gripper.pads)
        names.push_back(robot.name + "/" + robot.kinematics.links[link].name);
  if (names.empty()) return "";
  std::string out = std::string("free but for the ") + (names.size() == 1 ? "pad " : "pads ") +
                    listed(names) + " with what " + (names.size() == 1 ? "it holds" : "they hold");
  if (const std::vector<std::string> others = links_that_touch(world); !others.empty())
    out += std::string(", the ") + (others.size() == 1 ? "link " : "links ") + listed(others) +
           " with what " + (others.size() == 1 ? "it holds or pushes" : "they hold or push");
  if (!world.allowed.empty()) out += ", and contacts that the scene allows";
  return out;
}

std::vector<std::string> notes_of_pads(const World& world) {
  std::vector<std::string> out;
  for (std::size_t o = 0; o < world.attachments.size(); ++o)
    if (const auto& held = world.attachments[o]; held && !held->link_touches)
      out.push_back("contact of " + world.objects[o].name + " and " + name_pads(world, *held) +
                    ", which hold it, is left out");
  return out;
}

}  // namespace kaboum::world
