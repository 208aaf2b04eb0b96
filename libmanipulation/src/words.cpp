// Words for configurations and poses: decimal numbers, so that a plan can be read, checked and
// executed without the process that made it.
#include <kaboum/base/error.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/gripper.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>

namespace kaboum::manipulation {
namespace {

/// Decimals of configurations: a nanometre, and as many radians.
constexpr int kDecimals = 9;
/// Of poses. Fewer, so that an object that was put to the same place in two ways, by configurations
/// that inverse kinematics knows within 1e-9, is in the same state nearly always.
constexpr int kPoseDecimals = 7;
/// Numbers below have 15 digits, which a double keeps.
constexpr double kLargest = 1e6;

void append(std::string& out, double value, int decimals) {
  if (!(std::abs(value) < kLargest))
    throw Error(ErrorCode::LimitReached, "a number of 1e6 or more for a word of the planner");
  char buffer[32];
  auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  while (end[-1] == '0') --end;
  if (end[-1] == '.') --end;
  const std::string_view digits(buffer, static_cast<std::size_t>(end - buffer));
  out += ' ';
  out += digits == "-0" ? "0" : digits;
}

[[noreturn]] void unknown(std::string_view word, const std::string& expected) {
  throw Error(ErrorCode::InvalidInput, "'" + std::string(word) + "' is no " + expected);
}

/// Numbers after blanks; false: there is something else.
bool read_numbers(std::string_view text, std::vector<double>& out) {
  const char *at = text.data(), *end = at + text.size();
  while (at != end) {
    if (*at++ != ' ') return false;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(std::abs(value) < kLargest)) return false;
    out.push_back(value);
    at = next;
  }
  return true;
}

void append_pose(std::string& out, const world::Transform& pose) {
  for (int i = 0; i < 3; ++i) append(out, pose.translation[i], kPoseDecimals);
  Eigen::Quaterniond q(pose.linear);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  for (const double part : {q.x(), q.y(), q.z(), q.w()}) append(out, part, kPoseDecimals);
}

world::Transform pose_of(std::string_view numbers, std::string_view word) {
  std::vector<double> v;
  constexpr double kUnit = 1e-6;  ///< of a quaternion that is meant to be of unit length
  if (!read_numbers(numbers, v) || v.size() != 7 ||
      !(std::abs(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6] - 1) < kUnit))
    unknown(word, "pose: expected seven numbers, the last four a quaternion of unit length");
  world::Transform out;
  out.translation = {v[0], v[1], v[2]};
  out.linear = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix();
  return out;
}

constexpr std::string_view kBy = " by ";

/// How a link holds an object. @param rest  of the word, after the link
world::Attachment attachment_of(std::string_view rest, std::string_view word,
                                const world::World& world, std::size_t object, std::size_t robot,
                                std::uint32_t link) {
  const std::size_t by = rest.find(kBy);
  const world::Transform pose = pose_of(rest.substr(0, by), word);
  world::Grasp none;
  if (by == std::string_view::npos) {
    world::Attachment out;
    out.robot = robot;
    out.link = link;
    out.pose = pose;
    if (world::gripper_with_pads(world.robots[robot], link) == nullptr)
      out = world::hold_by(world, robot, link, pose, none);
    return out;
  }
  const std::string_view name = rest.substr(by + kBy.size());
  const std::vector<world::Grasp>& grasps = world.objects[object].grasps;
  const auto grasp = std::ranges::find(grasps, name, &world::Grasp::name);
  const world::Gripper* gripper = world::gripper_with_pads(world.robots[robot], link);
  if (grasp == grasps.end() || gripper == nullptr ||
      world::find_misfit(world.robots[robot], *gripper, *grasp))
    unknown(word, "pose of '" + world.objects[object].name + "' by a grasp of its, in pads of '" +
                      world.robots[robot].name + "'");
  return world::hold_by(world, robot, link, pose, *grasp);
}

}  // namespace

std::string word_of(const std::vector<double>& q) {
  std::string out = "q";
  for (const double value : q) append(out, value, kDecimals);
  return out;
}

std::vector<double> configuration_of(std::string_view word, const world::RobotModel& robot) {
  if (word == kHome) return robot.home;
  std::vector<double> out;
  if (word.empty() || word.front() != 'q' || !read_numbers(word.substr(1), out))
    unknown(word, "configuration: expected 'home' or 'q' and numbers");
  if (out.size() != robot.kinematics.variables.size())
    unknown(word, "configuration of '" + robot.name + "', which has " +
                      std::to_string(robot.kinematics.variables.size()) + " joint values");
  return out;
}

std::string word_of(const world::Transform& pose) {
  std::string out = "at";
  append_pose(out, pose);
  return out;
}

std::string word_of(const world::World& world, const world::Attachment& attachment) {
  const world::RobotModel& robot = world.robots[attachment.robot];
  std::string out = "on " + robot.name + "/" + robot.kinematics.links[attachment.link].name;
  append_pose(out, attachment.pose);
  if (!attachment.link_touches) out += std::string(kBy) + attachment.grasp;
  return out;
}

std::string word_of(const world::World& world, std::size_t object, const world::Transform& pose) {
  std::string out = "in " + world.objects[object].name;
  append_pose(out, pose);
  return out;
}

ObjectPlace place_of(std::string_view word, const world::World& world, std::size_t object) {
  ObjectPlace out;
  if (word == kAway) {
    out.absent = true;
  } else if (word == kStart) {
    out.pose = world.objects[object].pose;
    out.attachment = world.attachments[object];
  } else if (word.starts_with("at ")) {
    out.pose = pose_of(word.substr(2), word);
  } else if (word.starts_with("on ")) {
    for (std::size_t r = 0; r < world.robots.size() && !out.attachment; ++r) {
      const world::RobotModel& robot = world.robots[r];
      for (std::uint32_t link = 0; link < robot.kinematics.links.size(); ++link) {
        const std::string name = "on " + robot.name + "/" + robot.kinematics.links[link].name + " ";
        if (!word.starts_with(name)) continue;
        out.attachment = attachment_of(word.substr(name.size() - 1), word, world, object, r, link);
        break;
      }
    }
    if (!out.attachment) unknown(word, "pose on a link of the scene's robots");
  } else if (word.starts_with("in ")) {
    for (std::size_t o = 0; o < world.objects.size() && !out.mounted_on; ++o) {
      const std::string name = "in " + world.objects[o].name + " ";
      if (o == object || !word.starts_with(name)) continue;
      out.mounted_on = o;
      out.pose = pose_of(word.substr(name.size() - 1), word);
    }
    if (!out.mounted_on) unknown(word, "pose in another object of the scene");
  } else {
    unknown(word, "pose: expected 'start', 'away', 'at …', 'on ROBOT/LINK …' or 'in OBJECT …'");
  }
  return out;
}

}  // namespace kaboum::manipulation
