// What two links of a robot do over all values of the joints between them: places are sampled for
// contacts; boxes of values are halved until the links are proved apart in them, or overlapping.

#include "pair_proof.h"

#include <kaboum/base/radical_inverse.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/sweep/motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "placement.h"

namespace kaboum::world::detail {
namespace {

using collide::PosedSet;
using Reason = AllowedPair::Reason;

std::uint32_t next_prime(std::uint32_t n) {
  for (;;) {
    ++n;
    bool prime = n > 1;
    for (std::uint32_t d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
    if (prime) return n;
  }
}

/// An outer set lies in itself.
BoundingSet inner_of(const BoundingSet& outer) {
  std::vector<geom::ConvexBody> bodies;
  for (std::size_t i = 0; i < outer.size(); ++i) bodies.push_back(outer.body(i));
  return {std::move(bodies), collide::Direction::Inner, 0};
}

/// Values of the joints between two links, halved until proved.
class Proof {
 public:
  Proof(const RobotModel& robot, const LinkShape& a, const LinkShape& b, const PairOptions& options)
      : robot_(robot),
        options_(options),
        a_(a),
        b_(b),
        at_a_(a.outer),
        at_b_(b.outer),
        own_a_(inner_of(a.outer)),
        own_b_(inner_of(b.outer)) {
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
    // What meets somewhere is mostly seen at once; what meets everywhere, in most of these places.
    const bool everywhere = sample(low, high);
    if (!meets_) {
      if (apart(low, high)) out.reason = Reason::Never;
    } else if (everywhere) {
      boxes_ = 0;
      out.meets_always = meet(low, high);
    }
    out.meets = meets_;
    if (variables_.empty() && meets_) {
      out.meets_always = true;
      out.reason = Reason::Always;
    }
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

  /// Looks for a contact at the box's middle and at places spread over it (Halton's sequence).
  /// @return whether all of them are one.
  bool sample(const std::vector<double>& low, const std::vector<double>& high) {
    const std::size_t samples = variables_.empty() ? 1 : options_.samples;
    bool all = true;
    std::vector<double> q(low.size(), 0);
    for (std::size_t i = 0; i < samples && (all || !meets_) && !stopped(); ++i) {
      std::uint32_t base = 1;
      for (const std::uint32_t v : variables_) {
        base = next_prime(base);
        q[v] = low[v] + (high[v] - low[v]) * (i == 0 ? 0.5 : radical_inverse(i, base));
      }
      const std::vector<Transform> poses = forward(robot_.kinematics, q);
      at_a_.place(poses[a_.link]);
      at_b_.place(poses[b_.link]);
      const bool contact = find_collision(at_a_, at_b_, 0, &memory_).has_value();
      meets_ = meets_ || contact;
      all = all && contact;
    }
    return all;
  }

  [[nodiscard]] bool stopped() const { return options_.stop && options_.stop(); }

  /// Whether no box is left to look at.
  bool out_of_work() { return ++boxes_ > options_.most_boxes || stopped(); }

  static std::vector<double> middle_of(const std::vector<double>& low,
                                       const std::vector<double>& high) {
    std::vector<double> middle(low.size());
    for (std::size_t i = 0; i < low.size(); ++i) middle[i] = 0.5 * low[i] + 0.5 * high[i];
    return middle;
  }

  /// Calls part(low, high) for both halves of a box along the variable that moves the links most,
  /// until it is false.
  template <typename Part>
  bool halve(const std::vector<double>& low, const std::vector<double>& high,
             const std::vector<double>& middle, const Part& part) {
    if (variables_.empty()) return false;
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
    return part(low, first) && part(second, high);
  }

  /// Whether the sets meet all over the box: bodies overlap by more than they move.
  bool meet(const std::vector<double>& low, const std::vector<double>& high) {
    if (out_of_work()) return false;
    const std::vector<double> middle = middle_of(low, high);
    const std::vector<Transform> poses = forward(robot_.kinematics, middle);
    const Reach x = reach(a_, points_a_, low, high), y = reach(b_, points_b_, low, high);
    const PosedSet a(own_a_, poses[a_.link], (x.move + x.error) * (1 + 0x1p-40)),
        b(own_b_, poses[b_.link], (y.move + y.error) * (1 + 0x1p-40));
    if (certainly_collide(a, b)) return true;
    at_a_.place(poses[a_.link]);
    at_b_.place(poses[b_.link]);
    if (!find_collision(at_a_, at_b_, 0, &memory_)) return false;
    return halve(low, high, middle,
                 [&](const auto& from, const auto& to) { return meet(from, to); });
  }

  bool apart(const std::vector<double>& low, const std::vector<double>& high) {
    if (out_of_work()) return false;
    const std::vector<double> middle = middle_of(low, high);
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
    return halve(low, high, middle,
                 [&](const auto& from, const auto& to) { return apart(from, to); });
  }

  const RobotModel& robot_;
  const PairOptions& options_;
  const LinkShape &a_, &b_;
  std::vector<Vec3> points_a_, points_b_;
  std::set<std::uint32_t> below_, variables_;
  PosedSet at_a_, at_b_;
  BoundingSet own_a_, own_b_;  ///< the sets as inner sets of themselves
  collide::Memory memory_;
  std::size_t boxes_ = 0;
  bool meets_ = false;
};

}  // namespace

LinkPair examine_pair(const RobotModel& robot, const LinkShape& a, const LinkShape& b,
                      const PairOptions& options) {
  return Proof(robot, a, b, options).run();
}

}  // namespace kaboum::world::detail
