#pragma once

#include <kaboum/world/world.h>

#include <string>
#include <string_view>

/// Geometry for the planner: words for configurations and poses, and external functions that look
/// for them in a world. docs/planning/geometry.md.
namespace kaboum::manipulation {

/// Words of handle types that stand for what a scene says.
inline constexpr std::string_view kHome = "home";    ///< a robot's home
inline constexpr std::string_view kStart = "start";  ///< where an object is at first
inline constexpr std::string_view kAway = "away";    ///< an object has left the world

/// A configuration as the word of a handle, "q 0.1 -1.2": values rounded to multiples of 1e-9.
/// What is said of a word is said of the rounded values. [rad or length]
/// @throws Error{LimitReached} for values from 1e6 on, or that are not finite.
std::string word_of(const std::vector<double>& q);

/// `kHome`, or what `word_of` gave.
/// @throws Error{InvalidInput} for other words, and another number of values than variables.
std::vector<double> configuration_of(std::string_view word, const world::RobotModel& robot);

/// Place of an object.
struct ObjectPlace {
  bool absent = false;
  world::Transform pose;  ///< to the world; of attached objects, not used
  /// `touching` is that of the link's grippers; of one with pads as the grasp says.
  std::optional<world::Attachment> attachment;
  std::optional<std::size_t> mounted_on;  ///< an object; `pose` is to that one's frame
};

/// "at x y z qx qy qz qw", rounded to multiples of 1e-7.
/// @throws Error{LimitReached} as above.
std::string word_of(const world::Transform& pose);
/// "on ROBOT/LINK x y z qx qy qz qw", and where pads hold it " by GRASP".
std::string word_of(const world::World& world, const world::Attachment& attachment);

/// "in OBJECT x y z qx qy qz qw": mounted on another object, with which it moves.
std::string word_of(const world::World& world, std::size_t object, const world::Transform& pose);

/// `kStart`, `kAway`, or what `word_of` gave.
/// @throws Error{InvalidInput} for other words.
ObjectPlace place_of(std::string_view word, const world::World& world, std::size_t object);

}  // namespace kaboum::manipulation
