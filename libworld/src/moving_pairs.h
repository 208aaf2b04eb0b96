#pragma once

#include <kaboum/world/motion_check.h>

#include <optional>
#include <span>
#include <vector>

#include "mover.h"

namespace kaboum::world::detail {

/// The path of a robot, where somebody else keeps it.
struct MovingRobot {
  std::size_t robot = 0;
  const robot::Path* path = nullptr;
  const std::vector<double>* around = nullptr;  ///< MotionOptions::around; null: on the line
};

/// The pairs of things of which at least one moves while robots go along paths of equally many
/// waypoints, placed at instants of one segment after another.
class MovingPairs {
 public:
  struct Pair {
    std::size_t mover = 0;             ///< number of a Mover
    std::optional<std::size_t> other;  ///< another one, else something that rests
    std::size_t rest = 0;
    double speed = 0;   ///< bound of how fast they approach each other in a segment [length]
    double margin = 0;  ///< that they are to be kept from each other [length]
    /// How much nearer than on the line of a segment they may be. [length]
    double room = 0;
    /// Of that, what comes of fingers of another robot, which rests and holds something. [length]
    double room_at_rest = 0;
  };

  /// @param scratch  that is used; may be null.
  /// @param things  only pairs with one of these that rest; all pairs where it is null.
  MovingPairs(const Checker& checker, const WorldState& state, std::vector<MovingRobot> robots,
              Scratch* scratch, const std::vector<Item>* things = nullptr);

  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  [[nodiscard]] const Item& mover(const Pair& pair) const { return movers_[pair.mover].item; }
  [[nodiscard]] const Item& other(const Pair& pair) const {
    return pair.other ? movers_[*pair.other].item : resting_[pair.rest].item;
  }

  /// What is asked from now on is about this segment.
  void prepare(std::size_t segment) { prepare(segment, all_); }
  /// The same, of some pairs only.
  void prepare(std::size_t segment, std::span<const std::size_t> pairs);
  /// The numbers of all pairs.
  [[nodiscard]] const std::vector<std::size_t>& all() const { return all_; }
  /// Puts what moves, of some pairs, where it is at a share of the segment.
  void place(double at, const std::vector<std::size_t>& pairs);
  /// Whether the outer sets of a pair come within its margin, its room and `slack` of each other
  /// there.
  [[nodiscard]] std::optional<collide::BodyPair> ask(std::size_t pair, double slack) {
    const double margin = pairs_[pair].margin + pairs_[pair].room;
    const double within = margin > 0 ? (margin + slack) * (1 + 0x1p-50) : slack;
    return find_collision(first(pair), second(pair), within, &memory_[pair]);
  }
  [[nodiscard]] const collide::PosedSet& first(std::size_t pair) const {
    return places_[pairs_[pair].mover];
  }
  [[nodiscard]] const collide::PosedSet& second(std::size_t pair) const {
    return pairs_[pair].other ? places_[*pairs_[pair].other] : resting_[pairs_[pair].rest].place;
  }

 private:
  std::size_t mover_of(const Item& item, const WorldState& state);
  [[nodiscard]] const RobotModel& model_of(const Mover& m) const { return world_.robots[m.robot]; }
  [[nodiscard]] const robot::Path& path_of(const Mover& m) const;
  [[nodiscard]] double speed_of(const Mover& m, const std::vector<double>& from,
                                const std::vector<double>& to) const;
  void make_room(std::size_t segment);

  const Checker& checker_;
  const World& world_;
  std::vector<MovingRobot> robots_;
  std::vector<Mover> movers_;
  std::vector<collide::PosedSet> places_;  ///< of the movers
  std::vector<char> placed_;
  std::vector<Checker::PosedItem> resting_;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> all_;
  std::vector<collide::Memory> memory_;
  std::vector<std::optional<sweep::LinkMotion>> motions_;  ///< of movers of prepared pairs
  std::vector<double> errors_;
};

}  // namespace kaboum::world::detail
