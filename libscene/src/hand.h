#pragma once

#include <kaboum/world/checker.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Contacts of an object with the hand that holds it.
namespace kaboum::scene {

/// Values that one freedom of a family of grasps has.
struct Range {
  double from = 0, to = 0;
};

/// Members of a family of grasps: all whose values are in these ranges, of the slides, then of the
/// turn.
using MemberBox = std::vector<Range>;

/// The largest ε of what is fixed to a link.
double epsilon_at(const world::RobotModel& robot, std::uint32_t link);

/// A robot's hand (what moves with its tool) and an object in it, away from all else.
class Hand {
 public:
  /// Refers to the world.
  Hand(const world::World& world, std::size_t object, std::size_t robot,
       const world::ToolFrame& tool);

  /// A link of the hand that the object is in contact with; nullopt: none.
  std::optional<std::string> contact_at(const geom::Transform& grasp);

  /// True if the object is free of contact with the hand at all members of a box, for certain: the
  /// box has parts, and what holds the object at all members of a part is apart from the hand.
  /// False where a member is in contact, or where `most` parts decide nothing.
  bool is_free(const world::Grasp& grasp, const MemberBox& box, std::size_t most);

  /// The part of the hand whose contact with the object is not looked at.
  struct Unchecked {
    std::vector<std::string> links;  ///< without a set, or with an allowed contact
    bool all = true;
  };
  [[nodiscard]] Unchecked unchecked() const;

 private:
  /// A shape of the hand whose contact with the object is looked at.
  struct Part {
    collide::PosedSet place;
    double margin;  ///< that it is kept from the object
  };
  [[nodiscard]] bool is_allowed(std::size_t shape) const;
  /// False if the object is free of contact with the hand at all members, for certain.
  bool may_meet(const world::Grasp& grasp, const MemberBox& box);
  /// No point of the object is farther from the axis of the turn, wherever the slides have it.
  [[nodiscard]] double reach_of(const world::Grasp& grasp, const MemberBox& box) const;
  bool is_free_within(const world::Grasp& grasp, const MemberBox& box, std::size_t& left);

  const world::World& world_;
  std::size_t object_, robot_;
  world::Checker checker_;
  world::Scratch scratch_;
  world::WorldState state_;
  std::vector<bool> hand_;
  geom::Transform tool_;
  std::vector<Part> parts_;
  std::vector<collide::BoundingSet::Ball> balls_;  ///< that hold the cores of the object's bodies
};

}  // namespace kaboum::scene
