#pragma once

#include <kaboum/world/motion_check.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace kaboum::world {

/// Decides stretches of straight motions of a robot, exactly, where others have decided the rest.
/// What its questions share is made once. It has the memory of one thread, so threads may not share
/// it.
class StretchChecker {
 public:
  /// Refers to the checker.
  /// @throws as check_motion; Error{InvalidArgument} for a checker with a substitute.
  StretchChecker(const Checker& checker, const WorldState& state, std::size_t robot);
  ~StretchChecker();
  StretchChecker(StretchChecker&&) noexcept;
  StretchChecker& operator=(StretchChecker&&) noexcept;
  StretchChecker(const StretchChecker&) = delete;
  StretchChecker& operator=(const StretchChecker&) = delete;

  struct Answer {
    bool apart = false;         ///< for certain; false says nothing
    std::size_t intervals = 0;  ///< of time that were looked at
  };

  /// Whether the pairs that check_motion looks at are apart by more than a distance, besides their
  /// margins, at every instant of some stretches.
  /// @param from, to  a value for each variable, within the limits
  /// @param stretches  from a share of the motion to another one, ascending: parts of [0, 1] that
  ///   come of halving it again and again
  /// @param distance  > 0 [length]
  /// @param most_intervals  that are looked at
  /// @param pairs  that are looked at; none: all
  /// @pre all pairs are so far apart at every instant that is in none of the stretches, and those
  ///   that are not looked at are so always
  /// @throws Error{InvalidArgument} for a pair that check_motion does not look at
  Answer is_apart(std::span<const double> from, std::span<const double> to,
                  std::span<const std::array<double, 2>> stretches, double distance,
                  std::size_t most_intervals, std::span<const std::array<Item, 2>> pairs = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaboum::world
