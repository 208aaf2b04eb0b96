#pragma once

#include <functional>

#include "lines.h"
#include "motion_sequence.h"
#include "push_contact.h"

namespace kaboum::manipulation {

/// Motions that make an action: reaching, grasping, putting down, mounting, handing over.
class Sequence : public MotionSequence {
 public:
  using MotionSequence::MotionSequence;

  // Each is true when it was done.
  /// Whether inverse kinematics knows a configuration that reaches the object by a grasp.
  bool is_in_reach(std::size_t robot, std::size_t object) {
    return reaches_any(robot, object) || goals_in_reach(robot, object).has_value();
  }
  /// To where a tool holds the object by one of its grasps. It may be held by another robot.
  bool reach(std::size_t robot, std::size_t object);
  /// Holds the object, with what is mounted on it, by the tool that is at one of its grasps; a
  /// gripper with joints closes on it.
  bool take(std::size_t robot, std::size_t object);
  /// To where the held object stands on another one; upright all the way, if that is asked for.
  bool place(std::size_t robot, std::size_t object, std::size_t support, bool upright);
  /// To where the held object's plane `mount` is on the plane `seat` of another one, along the
  /// seat's normal at last.
  bool mount(std::size_t robot, std::size_t object, std::size_t onto);
  /// To where constraints between the held object and another one are met; it is mounted on that
  /// one when it is let go.
  bool mate(std::size_t robot, std::size_t object, std::size_t onto,
            const world::ConstraintSet& constraints);
  /// The robot is where a call says that it is.
  void start_at(std::size_t robot, const std::vector<double>& q) {
    state_.q[robot] = with_fingers(robot, q);
  }
  /// Lets go what stands or is mounted, at the very pose that was meant; a gripper with joints
  /// opens. @return false: it cannot
  bool let_go(std::size_t robot, std::size_t object);
  /// The tool straight back from what was mounted, as far as that slid in.
  bool withdraw(std::size_t robot);
  /// Straight up with the held object.
  bool lift(std::size_t robot, std::size_t object, double height);
  /// Both robots to where one can grasp what the other one holds; then it holds it.
  bool hand_over(std::size_t from, std::size_t object, std::size_t to);
  /// Pushes an object along a straight line on what it stands on, and backs off.
  bool push(std::size_t robot, std::size_t object, std::size_t support);
  /// To some configuration, at random.
  bool wander(std::size_t robot);
  /// To where constraints of the scene are met, between features that move with the robot or what
  /// it carries and features of things where they are.
  bool satisfy(std::size_t robot, const world::ConstraintSet& constraints) {
    return satisfy(robot, constraints, [&](const Goals& goals) { return go(robot, goals); });
  }

 private:
  /// A held object, as it is about to be let go.
  struct Target {
    std::size_t object = 0;
    world::Transform pose;
    std::optional<std::size_t> onto;
    std::uint32_t link = 0;  ///< that holds it
    double depth = 0;        ///< how far the tool has to withdraw [length]
  };

  /// A place on a support: where the object's point `bottom` is to stand, in the support's frame,
  /// and the object's turn about the vertical.
  struct Footing {
    geom::Vec3 point;
    double angle = 0;
  };
  /// @param points  of the support that things are put on
  std::vector<Footing> footings(std::size_t object, std::size_t support, std::size_t points);
  /// A grasp, or a member of a family, by a tool that may use it.
  struct Hold {
    const world::Grasp* grasp;
    const world::ToolFrame* tool;
    world::Transform pose;  ///< from the object's frame to the tool's
  };
  /// In the scene's order. @param draws  members of each family
  [[nodiscard]] std::vector<Hold> holds(std::size_t robot, std::size_t object,
                                        std::size_t draws) const;
  /// @param any  as of GoalSearch
  void add_goals_of(Goals& goals, std::size_t robot, std::size_t object, const Hold& hold,
                    bool any = false) const;
  /// Members of a family that this attempt draws.
  [[nodiscard]] std::size_t draws() const;
  /// @param rank  of the grasps; nullopt: of any
  [[nodiscard]] Goals goals_of_reach(std::size_t robot, std::size_t object,
                                     std::optional<unsigned> rank = std::nullopt) const;
  /// Whether no tool comes as near to the object as the grasps that are listed have it, however the
  /// robot stretches: then no other grasp is in reach either.
  [[nodiscard]] bool is_beyond_reach(std::size_t robot, std::size_t object) const;
  [[nodiscard]] std::optional<std::size_t> find_beyond_reach(std::size_t robot,
                                                             const world::ConstraintSet& set) const;
  /// @param reach  goes to one of some goals
  bool satisfy(std::size_t robot, const world::ConstraintSet& constraints,
               const std::function<bool(const Goals&)>& reach);
  [[nodiscard]] Goals goals_that_meet(std::size_t robot,
                                      const std::vector<motion::PathConstraint>& constraints) const;
  /// To a goal at which an object is mounted on another one, along a straight line at last: of the
  /// axes and normals that its constraints are about, from beyond the other one.
  bool slide_onto(std::size_t robot, std::size_t object, std::size_t onto,
                  const world::ConstraintSet& constraints, const Goals& goals);
  /// By the one grasp that the question's choice prefers; nullopt: it prefers none.
  std::optional<Goals> preferred_goals(std::size_t robot, std::size_t object);
  /// "o1, held by its grasp 'side'"
  [[nodiscard]] std::string name_with_grasp(std::size_t object,
                                            const world::Attachment& held) const;
  /// Whether there is a configuration for some grasp; false: it takes longer to tell.
  [[nodiscard]] bool reaches_any(std::size_t robot, std::size_t object) const;
  /// nullopt: it is out of reach.
  std::optional<Goals> goals_in_reach(std::size_t robot, std::size_t object);
  /// Turns about the vertical, or a seat's normal, that are tried.
  [[nodiscard]] std::vector<double> turns();
  /// Which grasps of the object the robot that takes it may use.
  enum class Grasps : std::uint8_t { Preferred, All };
  bool meet(std::size_t from, std::size_t object, std::size_t to, const std::vector<double>& q,
            Grasps grasps);
  bool meet_somewhere(std::size_t from, std::size_t object, std::size_t to, Grasps grasps);

  struct PushSide;
  /// Sides that the object can be pushed from; none: the reason is kept.
  std::vector<PushSide> push_sides(std::size_t robot, std::size_t object,
                                   const PushedObject& pushed);
  bool push_along(std::size_t robot, std::size_t object, const PushedObject& pushed,
                  const PushContact& contact, const std::vector<double>& q, double length);

  std::optional<Target> target_;
};

}  // namespace kaboum::manipulation
