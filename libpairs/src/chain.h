#pragma once

#include <kaboum/robot/robot.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::pairs::detail {

using geom::Transform;
using geom::Vec3;

/// The joints between two links a and b, from a on, those on the way up turned round: what poses of
/// b relative to a depend on. Joints above the link that both hang from are none of them.
class Chain {
 public:
  Chain(const robot::Robot& robot, std::uint32_t a, std::uint32_t b);

  struct Joint {
    bool revolute = true;
    std::size_t variable = 0;  ///< of variables()
    double multiplier = 1;  ///< of it; negative for those that are turned round, if not so before
    double most = 0;        ///< largest |value| within the limits
  };
  /// The robot's variables that drive a joint, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& variables() const { return variables_; }
  [[nodiscard]] const std::vector<Joint>& joints() const { return joints_; }
  /// Limits of the variables; of those without, one turn. nullopt: there is no turn.
  struct Limits {
    std::vector<double> low, high;
  };
  [[nodiscard]] const std::optional<Limits>& limits() const { return limits_; }
  /// Those within which joints that mimic others keep their own limits as well: where contacts may
  /// be shown. nullopt: nowhere.
  [[nodiscard]] const std::optional<Limits>& own_limits() const { return own_limits_; }

  /// Where b and the joints are, in the frame of a.
  struct Placed {
    Transform b;
    std::vector<Vec3> axes, origins;  ///< of each joint
  };
  void place(std::span<const double> values, Placed& out) const;

  /// The sum of what is between the frames within the limits: no point of one is farther from the
  /// other, but for what it is from its own frame. [length]
  [[nodiscard]] double extent() const { return extent_; }
  /// How far a computed place of a point is from the exact one at most, of points within `reach` of
  /// the frames of a and b. docs/algorithms/pairs.md, "Rounding".
  [[nodiscard]] double error(double reach) const;

 private:
  struct Step {
    Transform before;
    Vec3 axis;
    double offset;
  };
  void find_limits(const robot::Robot& robot);
  void narrow(const robot::Joint& joint);

  std::vector<std::uint32_t> variables_;
  std::vector<Joint> joints_;
  std::vector<Step> steps_;
  Transform after_;
  std::optional<Limits> limits_, own_limits_;
  double extent_ = 0;
  std::size_t factors_ = 1;
};

}  // namespace kaboum::pairs::detail
