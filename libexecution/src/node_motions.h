#pragma once

#include <kaboum/world/checker.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "motion_part.h"
#include "simulation_state.h"

namespace kaboum::execution {

/// The motions of a plan's nodes, as they are carried out. With blends, motions of a call that
/// follow each other without a change of what is held are one, and blends are as large as they are
/// certified for samples of the options' rate (motion::certified_blends): in the state that the
/// motion is in, with what it holds, keeping what manipulation::kept_constraints says. A motion of
/// which nothing is certified but its path goes from rest to rest along that.
class NodeMotions {
 public:
  /// All arguments outlive it.
  /// @throws as require_valid
  NodeMotions(const world::World& world, const plan::Model& model, const plan::Plan& plan,
              SimulationOptions options);

  /// In their order. What was asked before is remembered.
  /// @param before  the node's state
  /// @throws as parts_of
  const std::vector<MotionPart>& of(plan::Index node, const StatedState& before);

 private:
  void blend(std::vector<MotionPart>& parts, world::WorldState& state,
             const plan::Plan::Call& call) const;
  void blend(MotionPart& part, const world::WorldState& state, const plan::Plan::Call& call) const;

  const world::World& world_;
  const plan::Model& model_;
  const plan::Plan& plan_;
  SimulationOptions options_;
  std::optional<world::Checker> checker_;  ///< with blends only
  std::map<std::pair<plan::Index, std::string>, std::vector<MotionPart>> known_;
};

}  // namespace kaboum::execution
