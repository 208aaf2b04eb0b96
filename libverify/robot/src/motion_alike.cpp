// Whether a robot with other shapes moves as the one it stands for.
#include <kaboum/verify/motion_alike.h>

#include <kaboum/base/number_text.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <vector>

namespace kaboum::verify {
namespace {

bool same(const robot::Transform& a, const robot::Transform& b) {
  return a.linear == b.linear && a.translation == b.translation;
}

bool same_limits(const robot::Variable& a, const robot::Variable& b) {
  return a.lower == b.lower && a.upper == b.upper;
}

/// What of a joint is not as it was; null if all is.
const char* difference(const robot::Robot& original, std::size_t i, const robot::Robot& result,
                       std::size_t k) {
  const robot::Joint &a = original.joints[i], &b = result.joints[k];
  if (a.type != b.type) return "is of another type";
  if (original.links[a.parent].name != result.links[b.parent].name) return "has another parent";
  if (original.links[i + 1].name != result.links[k + 1].name) return "has another child";
  if (!same(a.origin, b.origin)) return "has another origin";
  if (a.type == robot::JointType::Fixed) return nullptr;
  if (a.axis != b.axis) return "has another axis";
  const robot::Variable &x = original.variables[a.variable], &y = result.variables[b.variable];
  if (a.multiplier != b.multiplier || a.offset != b.offset || x.name != y.name)
    return "mimics in another way";
  return same_limits(x, y) ? nullptr : "has other limits";
}

/// A fixed step, then a joint's motion, forwards or backwards; at the end of a way there is none.
struct Step {
  robot::Transform fixed;
  const robot::Joint* joint = nullptr;
  bool backwards = false;
};

/// A way between links of a robot; fixed joints are part of the steps.
struct Way {
  std::vector<Step> steps = std::vector<Step>(1);

  void go(const robot::Transform& fixed) { steps.back().fixed = steps.back().fixed * fixed; }
  void turn(const robot::Joint& joint, bool backwards) {
    if (joint.type == robot::JointType::Fixed) return;
    steps.back().joint = &joint;
    steps.back().backwards = backwards;
    steps.emplace_back();
  }
};

robot::Transform inverse(const robot::Transform& t) {
  return {t.linear.transpose(), -(t.linear.transpose() * t.translation)};
}

/// Indices of joints from the root to a link.
std::vector<std::size_t> joints_to(const robot::Robot& robot, std::uint32_t link) {
  std::vector<std::size_t> out;
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) out.push_back(l - 1);
  std::ranges::reverse(out);
  return out;
}

Way way_between(const robot::Robot& robot, std::uint32_t from, std::uint32_t to) {
  const std::vector<std::size_t> up = joints_to(robot, from), down = joints_to(robot, to);
  std::size_t shared = 0;
  while (shared < std::min(up.size(), down.size()) && up[shared] == down[shared]) ++shared;
  Way out;
  for (std::size_t i = up.size(); i > shared; --i) {
    out.turn(robot.joints[up[i - 1]], true);
    out.go(inverse(robot.joints[up[i - 1]].origin));
  }
  for (std::size_t i = shared; i < down.size(); ++i) {
    out.go(robot.joints[down[i]].origin);
    out.turn(robot.joints[down[i]], false);
  }
  return out;
}

/// Two robots, and by how much their numbers may differ.
struct Comparison {
  const robot::Robot &original, &result;
  double turn = 0, length = 0;

  /// What of a moving joint is not as it was; null if all is.
  [[nodiscard]] const char* difference(const robot::Joint& a, const robot::Joint& b) const {
    if (a.type != b.type) return "is of another type";
    if (a.name != b.name) return "has another name";
    if (!((a.axis - b.axis).norm() <= turn)) return "has another axis";
    if (!(std::abs(a.multiplier - b.multiplier) <= turn * std::abs(a.multiplier)) ||
        !(std::abs(a.offset - b.offset) <=
          (a.type == robot::JointType::Revolute ? turn : length)) ||
        original.variables[a.variable].name != result.variables[b.variable].name)
      return "mimics in another way";
    return nullptr;
  }

  /// Why two ways need not lead to the same place; empty: they do.
  [[nodiscard]] std::string difference(const Way& a, const Way& b) const {
    const std::size_t count = std::min(a.steps.size(), b.steps.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Step &x = a.steps[i], &y = b.steps[i];
      const double apart = (x.fixed.translation - y.fixed.translation).norm(),
                   turned = (x.fixed.linear - y.fixed.linear).norm();
      if (!(apart <= length && turned <= turn)) {
        const robot::Joint* joint = x.joint != nullptr ? x.joint
                                    : i > 0            ? a.steps[i - 1].joint
                                                       : nullptr;
        return (joint != nullptr ? "a step beside joint '" + joint->name + "' is "
                                 : std::string("a fixed step is ")) +
               number_text(apart) + " away, turned by about " +
               number_text(turned / std::numbers::sqrt2) + " rad";
      }
      if ((x.joint == nullptr) != (y.joint == nullptr) || x.backwards != y.backwards)
        return x.joint != nullptr ? "joint '" + x.joint->name + "' does not move it there"
                                  : "joint '" + y.joint->name + "' moves it besides";
      if (x.joint == nullptr) continue;
      if (const char* what = difference(*x.joint, *y.joint))
        return "joint '" + x.joint->name + "' " + what;
    }
    return {};
  }
};

}  // namespace

std::optional<FrameElsewhere> find_frame_elsewhere(const robot::Robot& original,
                                                   const robot::Robot& result, double tolerance) {
  double size = 0;
  for (const robot::Transform& pose :
       robot::forward(original, std::vector<double>(original.variables.size(), 0.0)))
    size = std::max(size, pose.translation.norm());
  const Comparison compare{original, result, tolerance, tolerance * size};
  std::optional<std::uint32_t> first, its_first;
  for (std::uint32_t i = 0; i < original.links.size(); ++i) {
    const std::optional<std::uint32_t> k = result.find_link(original.links[i].name);
    if (!k) continue;
    std::string why;
    if (first) {
      why =
          compare.difference(way_between(original, *first, i), way_between(result, *its_first, *k));
    } else {
      first = i;
      its_first = k;
      if (i > 0 && *k > 0)
        why = compare.difference(way_between(original, 0, i), way_between(result, 0, *k));
    }
    if (!why.empty()) return FrameElsewhere{i, std::move(why)};
  }
  return std::nullopt;
}

bool same_frame(const robot::Geometry& a, const robot::Geometry& b) {
  return a.shape == b.shape && a.size == b.size && same(a.origin, b.origin);
}

std::string difference_in_motion(const robot::Robot& original, const robot::Robot& result) {
  if (original.links[0].name != result.links[0].name)
    return "the result's root is '" + result.links[0].name + "' instead of '" +
           original.links[0].name + "'";
  for (const robot::Link& link : original.links)
    if (!result.find_link(link.name)) return "the result has no link '" + link.name + "'";
  for (std::size_t i = 0; i < original.joints.size(); ++i) {
    const std::string& name = original.joints[i].name;
    const auto at = std::find_if(result.joints.begin(), result.joints.end(),
                                 [&](const robot::Joint& b) { return b.name == name; });
    if (at == result.joints.end()) return "the result has no joint '" + name + "'";
    const auto k = static_cast<std::size_t>(at - result.joints.begin());
    if (const char* what = difference(original, i, result, k))
      return "joint '" + name + "' " + what;
  }
  return {};
}

}  // namespace kaboum::verify
