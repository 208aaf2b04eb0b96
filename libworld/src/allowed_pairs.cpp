// Which links of a robot can touch each other at all.

#include <kaboum/robot/kinematics.h>
#include <kaboum/sweep/motion.h>
#include <kaboum/world/allowed_pairs.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "placement.h"

namespace kaboum::world {
namespace {

using collide::PosedSet;
using Reason = AllowedPair::Reason;

/// The link that fixed joints make one body with this one: the one nearest to the root.
std::uint32_t body_of(const robot::Robot& robot, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  return link;
}

/// A link itself if it has shapes or moves against its parent; else the nearest such one on the way
/// to the root: flanges and frames between a joint and what it carries.
std::uint32_t carrier_of(const robot::Robot& robot, std::uint32_t link) {
  while (link > 0 && robot.links[link].collision.empty() &&
         robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  return link;
}

/// The child, but for frames without shapes that are fixed between it and the joint that it hangs
/// on.
std::uint32_t joint_of(const robot::Robot& robot, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed &&
         robot.joints[link - 1].parent > 0 &&
         robot.links[robot.joints[link - 1].parent].collision.empty())
    link = robot.joints[link - 1].parent;
  return link;
}

/// Whether one joint connects both, with nothing that has shapes between them. What is fixed to the
/// one elsewhere (a camera, a wall beside a rail) is not meant: it may well be touched.
bool are_adjacent(const robot::Robot& robot, std::uint32_t a, std::uint32_t b) {
  const auto hangs_on = [&](std::uint32_t child, std::uint32_t parent) {
    if (child > 0 && robot.joints[child - 1].parent == parent) return true;
    const std::uint32_t joint = joint_of(robot, child);
    return joint > 0 && carrier_of(robot, robot.joints[joint - 1].parent) == parent;
  };
  return hangs_on(a, b) || hangs_on(b, a);
}

/// Values of the joints between two links, halved until proved.
class Proof {
 public:
  Proof(const RobotModel& robot, const LinkShape& a, const LinkShape& b, const PairOptions& options)
      : robot_(robot), options_(options), a_(a), b_(b), at_a_(a.outer), at_b_(b.outer) {
    points_a_ = detail::hull_points(a.outer);
    points_b_ = detail::hull_points(b.outer);
    std::set<std::uint32_t> first, second;
    for (std::uint32_t l = a.link; l > 0; l = parent(l)) first.insert(l);
    for (std::uint32_t l = b.link; l > 0; l = parent(l)) second.insert(l);
    std::set<std::uint32_t> above;
    for (const std::uint32_t l : first) (second.contains(l) ? above : below_).insert(l);
    for (const std::uint32_t l : second)
      if (!first.contains(l)) below_.insert(l);
    for (const std::uint32_t l : below_)
      if (joint(l).type != robot::JointType::Fixed) variables_.insert(joint(l).variable);
  }

  /// Whether a joint lies between the links at all.
  [[nodiscard]] bool can_move() const { return !variables_.empty(); }

  LinkPair run() {
    LinkPair out{std::min(a_.link, b_.link), std::max(a_.link, b_.link), std::nullopt, false};
    std::vector<double> low(robot_.kinematics.variables.size(), 0), high = low;
    for (const std::uint32_t v : variables_) {
      const robot::Variable& variable = robot_.kinematics.variables[v];
      if (variable.lower && variable.upper) {
        low[v] = *variable.lower;
        high[v] = *variable.upper;
        continue;
      }
      const std::optional<double> turn = period(v);
      if (!turn) return out;
      low[v] = variable.lower.value_or(variable.upper ? *variable.upper - *turn : -*turn / 2);
      high[v] = low[v] + *turn;
    }
    if (apart(low, high)) out.reason = Reason::Never;
    out.meets = meets_;
    return out;
  }

 private:
  [[nodiscard]] const robot::Joint& joint(std::uint32_t link) const {
    return robot_.kinematics.joints[link - 1];
  }
  [[nodiscard]] std::uint32_t parent(std::uint32_t link) const { return joint(link).parent; }

  /// The change of a variable after which all joints between the links are where they were; nullopt
  /// where there is none.
  [[nodiscard]] std::optional<double> period(std::uint32_t variable) const {
    double multiplier = 0;
    for (const std::uint32_t l : below_) {
      const robot::Joint& j = joint(l);
      if (j.type == robot::JointType::Fixed || j.variable != variable || j.multiplier == 0)
        continue;
      if (j.type == robot::JointType::Prismatic) return std::nullopt;
      if (multiplier != 0 && std::abs(j.multiplier) != multiplier) return std::nullopt;
      multiplier = std::abs(j.multiplier);
    }
    if (multiplier == 0) return 0;
    return 2 * std::numbers::pi / multiplier * (1 + 0x1p-40);
  }

  /// How far a point of the shape moves from where it is in the middle of the box, relative to what
  /// both links hang from; and the error of its place.
  struct Reach {
    double move, error;
  };
  [[nodiscard]] Reach reach(const LinkShape& shape, const std::vector<Vec3>& points,
                            const std::vector<double>& low, const std::vector<double>& high) const {
    const sweep::LinkMotion motion(robot_.kinematics, shape.link, low, high);
    const sweep::MotionBounds bounds(motion, points);
    // From the middle, half of the way; the middle is rounded.
    const double move = motion.moves() ? 0.5 * bounds.derivative(1) * (1 + 0x1p-40) : 0;
    return {move, detail::placement_error(bounds, {})};
  }

  bool apart(const std::vector<double>& low, const std::vector<double>& high) {
    if (++boxes_ > options_.most_boxes) return false;
    std::vector<double> middle(low.size());
    for (std::size_t i = 0; i < low.size(); ++i) middle[i] = 0.5 * low[i] + 0.5 * high[i];
    const std::vector<Transform> poses = forward(robot_.kinematics, middle);
    const Reach x = reach(a_, points_a_, low, high), y = reach(b_, points_b_, low, high);
    at_a_.place(poses[a_.link], x.error);
    at_b_.place(poses[b_.link], y.error);
    const double slack = (x.move + y.move) * (1 + 0x1p-40);
    if (!find_collision(at_a_, at_b_, slack, &memory_)) return true;
    if (slack == 0 || find_collision(at_a_, at_b_, 0, &memory_)) {
      meets_ = true;
      return false;
    }
    // The variable that moves them most.
    std::uint32_t widest = *variables_.begin();
    double most = -1;
    for (const std::uint32_t v : variables_) {
      std::vector<double> lower = middle, upper = middle;
      lower[v] = low[v];
      upper[v] = high[v];
      const double move =
          reach(a_, points_a_, lower, upper).move + reach(b_, points_b_, lower, upper).move;
      if (move <= most) continue;
      most = move;
      widest = v;
    }
    if (!(low[widest] < middle[widest] && middle[widest] < high[widest])) return false;
    std::vector<double> first = high, second = low;
    first[widest] = second[widest] = middle[widest];
    return apart(low, first) && apart(second, high);
  }

  const RobotModel& robot_;
  const PairOptions& options_;
  const LinkShape &a_, &b_;
  std::vector<Vec3> points_a_, points_b_;
  std::set<std::uint32_t> below_, variables_;
  PosedSet at_a_, at_b_;
  collide::Memory memory_;
  std::size_t boxes_ = 0;
  bool meets_ = false;
};

}  // namespace

std::vector<AllowedPair> connected_links(const robot::Robot& robot) {
  std::vector<AllowedPair> out;
  for (std::uint32_t a = 0; a < robot.links.size(); ++a)
    for (std::uint32_t b = a + 1; b < robot.links.size(); ++b)
      if (are_adjacent(robot, a, b))
        out.push_back({a, b, Reason::Adjacent});
      else if (body_of(robot, a) == body_of(robot, b))
        out.push_back({a, b, Reason::Always});
  return out;
}

std::vector<LinkPair> examine_pairs(const RobotModel& robot, const PairOptions& options) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, LinkPair> found;
  for (const LinkShape& a : robot.shapes) {
    for (const LinkShape& b : robot.shapes) {
      if (a.link >= b.link) continue;
      LinkPair pair{a.link, b.link, std::nullopt, false};
      if (are_adjacent(robot.kinematics, a.link, b.link)) {
        pair.reason = Reason::Adjacent;
      } else {
        Proof proof(robot, a, b, options);
        pair = proof.run();
        if (!proof.can_move() && pair.meets) pair.reason = Reason::Always;
      }
      const auto [known, is_new] = found.emplace(std::pair(a.link, b.link), pair);
      if (is_new) continue;
      known->second.meets = known->second.meets || pair.meets;
      if (known->second.reason != pair.reason) known->second.reason.reset();
    }
  }
  std::vector<LinkPair> out;
  out.reserve(found.size());
  for (const auto& [links, pair] : found) out.push_back(pair);
  return out;
}

}  // namespace kaboum::world
