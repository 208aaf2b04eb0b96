#pragma once

#include <kaboum/execution/exact_cell.h>
#include <kaboum/execution/planning_task.h>
#include <kaboum/execution/simulation.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kaboum::execution {

/// Formats of the files of a plan's motions.
enum class MotionFormat : std::uint8_t {
  Csv,   ///< motion::to_csv
  Json,  ///< trajectory_msgs/JointTrajectory of ROS 2 (motion::to_joint_trajectory)
  Yaml   ///< the same
};

/// Options of carrying out a plan.
struct PlanRunRequest {
  /// Outcomes of sensing, and planning again; `most` 0: an outcome without a branch is an error.
  plan::ReplanOptions replan;
  /// Its progress is told of new plans, too, unless these have their own.
  SimulationOptions simulation;
  std::vector<std::string> packages = {};  ///< folders that package:// URIs are looked up in
  /// Each motion's samples are written into this folder, in the order in which they are carried
  /// out, and what happens when: plan.json and events.csv (docs/planning/trajectories.md). Empty:
  /// none.
  std::filesystem::path trajectories = {};
  MotionFormat motion_format = MotionFormat::Csv;
};

/// The report on a plan that was carried out.
struct PlanRunReport {
  SimulationReport simulation;
  plan::ReplanSummary plans;
  std::size_t triangles = 0;  ///< of the exact meshes
  Notes notes;

  /// Every way came to its end, and nothing on it was wrong.
  [[nodiscard]] bool good() const { return simulation.good() && plans.complete(); }
};

/// Carries out a plan in simulation, and judges every sample by the scene's exact meshes.
///
/// @param model  of the task.
/// @throws Error{InvalidArgument} for a task without a scene; as exact_cell, Simulation and
///   plan::run_and_replan; Error{OutputFailed} for the folder of trajectories.
PlanRunReport run_plan(const PlanningTask& task, const plan::Model& model, const plan::Plan& plan,
                       const PlanRunRequest& request);

}  // namespace kaboum::execution
