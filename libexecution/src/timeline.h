#pragma once

#include <kaboum/execution/run_plan.h>
#include <kaboum/motion/trajectory.h>

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "node_motions.h"

namespace kaboum::execution {

/// A folder with a whole plan as it is carried out: a file for each motion, and plan.json and
/// events.csv, which say what follows what: motions, what is taken and let go, and what is sensed
/// (docs/planning/trajectories.md).
class Timeline {
 public:
  /// @param world  outlives it
  /// @throws Error{OutputFailed} for a folder that cannot be made
  Timeline(const world::World& world, std::filesystem::path folder, MotionFormat format,
           double rate);
  ~Timeline();
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;

  /// Another plan begins. Both outlive what is added of it.
  void begin(const plan::Model& model, const plan::Plan& plan,
             std::shared_ptr<NodeMotions> motions);
  /// The next motion of the step that is added next. @throws Error{OutputFailed}
  void add_motion(plan::Index node, std::size_t robot, const motion::Trajectory& trajectory);
  /// A node in a state. @pre its motions were added, if it was not in that state before
  void add(const plan::RunStep& step);
  /// Writes plan.json and events.csv. @throws Error{OutputFailed}
  /// @param replans  what was done for each step that was unplanned, in their order
  void write(const std::vector<plan::Replan>& replans) const;

 private:
  struct Data;
  std::size_t step_number(plan::Index node, const std::string& words);

  const world::World& world_;
  std::filesystem::path folder_;
  MotionFormat format_;
  const plan::Model* model_ = nullptr;
  const plan::Plan* plan_ = nullptr;
  std::shared_ptr<NodeMotions> motions_;
  std::size_t plans_ = 0, files_ = 0, unplanned_ = 0;
  std::map<std::pair<plan::Index, std::string>, std::size_t> steps_;  ///< of this plan
  std::unique_ptr<Data> data_;
};

}  // namespace kaboum::execution
