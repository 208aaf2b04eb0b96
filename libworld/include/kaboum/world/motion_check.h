#pragma once

#include <kaboum/robot/path.h>
#include <kaboum/world/checker.h>

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::world {

struct MotionOptions {
  /// Time is halved where bodies are near each other until they move less than this; what is not
  /// farther apart then counts as contact. > 0 [length]
  double resolution = 1e-5;
  std::size_t most_intervals = 1'000'000;
  /// True if it matters where in its segment a path stops being free; else the first contact that
  /// is seen ends the search, which takes less time: `share` is 0 then.
  bool where = true;
  Scratch* scratch = nullptr;  ///< that is used; null: one of its own
  /// How far each variable of the robot may be from the straight line of a segment, at any instant:
  /// what is free is free wherever it is within that, at every combination of the variables. Empty:
  /// it is on the line. Each ≥ 0; of check_motion and find_obstacles only (RobotPath has that of
  /// robots that move at once), and not of substitutes.
  /// [rad or length]
  std::vector<double> around = {};
  /// Is told now and then what is done; what it throws ends the work.
  std::function<void(const std::string& stage)> progress = {};
};

/// Of each variable the end of a segment that is farther from 0, and that moved away from 0 by at
/// least MotionOptions::around. sweep::MotionBounds of the motion between the two bound the way
/// from any point of the segment to any point within that (docs/scene.md, "Room about a path").
std::pair<std::vector<double>, std::vector<double>> outward(std::span<const double> from,
                                                            std::span<const double> to,
                                                            std::span<const double> around);

struct MotionAnswer {
  enum class Outcome {
    Free,       ///< at every instant of the path, for certain; of a substitute: at its samples
    Contact,    ///< outer sets meet, or come nearer than the resolution
    Undecided,  ///< most_intervals reached
  };
  Outcome outcome = Outcome::Free;
  /// Place where the path stops being certainly free: a segment from waypoint i to i + 1, and the
  /// share of it. With Contact, all before is free.
  std::size_t segment = 0;
  double share = 0;
  std::optional<Contact> contact;  ///< the first that was found; there is one with Contact
  /// Place of the contact: in `segment`, it was found at this share. Not below `share`.
  std::size_t contact_segment = 0;
  double contact_share = 0;
  /// Outer sets meet then, or do so within MotionOptions::around; false: they are nearer than the
  /// resolution.
  bool meets = false;
  std::size_t intervals = 0, queries = 0;
  /// Instants that a substitute was asked about (Checker); 0: all were decided.
  std::size_t samples = 0;
};

/// A robot and the waypoints that it goes along, a value per variable at each.
struct RobotPath {
  std::size_t robot = 0;
  robot::Path path;
  /// As MotionOptions::around, of this robot's variables.
  std::vector<double> around = {};
};

/// Decides whether a robot may move along a path of straight segments of joint values while all
/// else stays: at every instant, not at samples. A stretch of time is free when its middle is, with
/// all bodies enlarged by as much as they move in half of it: LinkMotion's bounds (docs/algorithms/
/// swept-volumes.md); other stretches are halved. What the robot carries moves with it.
///
/// Looked at are pairs with a link of this robot or with what it carries. Others may touch, as
/// another robot and an object, without being seen: Checker::find_contacts tells that of a state.
///
/// A checker with a substitute asks it at samples (Substitute::step), and certifies nothing.
///
/// @param path  a value per variable at each waypoint; the state's own values are not looked at.
/// @throws as Checker::find_contact; Error{InvalidArgument} for a path that is empty or does not
///   fit, `around` that does not fit or is not from 0 on, and a resolution that is not above 0.
MotionAnswer check_motion(const Checker& checker, const WorldState& state, std::size_t robot,
                          const robot::Path& path, const MotionOptions& options);

/// The same of several robots that move at once: at each share of a segment, all are at that share
/// of their own segments. Pairs of which both move are apart by as much as both may move.
/// @param paths  of different robots, with equally many waypoints.
/// @throws as check_motion; Error{InvalidArgument} for no paths, a robot that has two, and numbers
///   of waypoints that differ.
MotionAnswer check_motions(const Checker& checker, const WorldState& state,
                           const std::vector<RobotPath>& paths, const MotionOptions& options);

/// Things that are in the way of a path: not certainly apart, at every instant, from the robot and
/// what it carries. Each is decided about by itself, so that what is said of it depends on nothing
/// else in the state. Where none of all the things is in the way, and the path is free without
/// them, it is free (check_motion).
/// @param things  shapes of other robots, and objects that this robot does not carry.
/// @return some of these, ascending.
/// @throws as check_motion
std::vector<Item> find_obstacles(const Checker& checker, const WorldState& state, std::size_t robot,
                                 const robot::Path& path, const std::vector<Item>& things,
                                 const MotionOptions& options);

}  // namespace kaboum::world
