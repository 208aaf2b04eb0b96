#pragma once

#include <kaboum/judge/cell.h>

#include <map>
#include <vector>

#include "motion_part.h"

namespace kaboum::execution {

/// What holds an object: a link of a robot.
struct Holder {
  std::size_t robot = 0;
  std::uint32_t link = 0;
  bool operator==(const Holder&) const = default;
};
/// By object.
using Held = std::map<std::size_t, Holder>;

Held held_in(const judge::CellState& state);

/// What a robot does next in a node: it moves, closes or opens.
struct NodeEvent {
  enum class Kind : std::uint8_t { Move, Take, Release };
  Kind kind = Kind::Move;
  /// Of Move: its number among the node's; of Take and Release where fingers close or open, that of
  /// their motion.
  std::size_t motion = 0;
  std::size_t object = 0;      ///< of Take and Release
  Holder by = {};              ///< likewise
  bool other_link = false;     ///< of Take: another link of the same robot holds it
  bool moves_fingers = false;  ///< of Take and Release: `motion` closes or opens the gripper
};

/// The motions of a node, and what is taken and let go before each. What is handed over is taken
/// before it is let go: it never falls. From one link to another of the same robot there is no such
/// order.
/// @param held  before the node; is as at the end of its last motion then
std::vector<NodeEvent> motion_events(const std::vector<MotionPart>& parts, Held& held);

/// What is taken and let go when the motions of a node, and its sensing, are over.
/// @param after  the state after the node
/// @param held  is that of `after` then
std::vector<NodeEvent> settling_events(const judge::CellState& after, Held& held);

}  // namespace kaboum::execution
