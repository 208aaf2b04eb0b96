#pragma once

#include <kaboum/world/world.h>

#include <functional>
#include <limits>

namespace kaboum::world {

/// Pairs of links of which configurations say nothing: adjacent ones (one joint, but for frames
/// without shapes that are fixed between), and others between which there are fixed joints only
/// (Always).
std::vector<AllowedPair> connected_links(const robot::Robot& robot);
/// Links that have a set count as having shapes.
std::vector<AllowedPair> connected_links(const RobotModel& robot);

struct PairOptions {
  std::size_t most_boxes = 20'000;  ///< of joint values that are looked at for one pair
  std::size_t samples = 2'000;      ///< places at which contacts of a pair are looked for at first
  /// After so long nothing more is proved. [s]
  double most_seconds = std::numeric_limits<double>::infinity();
  std::function<bool()> stop = {};  ///< often called; true: nothing more is proved. May throw
};

/// Knowledge of a pair of links with shapes.
struct LinkPair {
  std::uint32_t a = 0, b = 0;  ///< a < b
  /// nullopt: they meet somewhere, or no proof was found.
  std::optional<AllowedPair::Reason> reason;
  bool meets = false;  ///< their outer sets do in a configuration that was found
  /// Proved: their outer sets meet in all configurations. Where the links move against each other
  /// that is no reason to leave them out: the solids may collide in some of these only.
  bool meets_always = false;
};

/// All pairs of a robot's links that have shapes:
/// - adjacent ones;
/// - those never in contact. That is proved for all values within the limits (for one turn of
///   joints without limits) by halving boxes of joint values until the links are farther apart than
///   they can move.
/// - those always in contact (a reason where they are connected by fixed joints only).
///
/// Outer sets are looked at, without the allowed pairs of the robot itself.
std::vector<LinkPair> examine_pairs(const RobotModel& robot, const PairOptions& options);

/// The pairs that need no check: connected ones, also of links without shapes, and of the others
/// those that were found never to meet; each once.
std::vector<AllowedPair> pairs_without_check(const RobotModel& robot,
                                             const std::vector<LinkPair>& examined);

/// SRDF with the pairs as <disable_collisions>.
std::string to_srdf(const RobotModel& robot, const std::vector<AllowedPair>& pairs);

}  // namespace kaboum::world
