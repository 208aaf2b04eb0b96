#pragma once

#include <kaboum/execution/robot_driver.h>
#include <kaboum/execution/run_plan.h>

#include <cstdint>
#include <optional>
#include <string>

namespace kaboum::execution {

/// The report on a plan that a robot driver carried out.
struct DriveReport {
  /// What was told and done, judged by the exact meshes as a simulation is, and the plans that were
  /// made on the way.
  PlanRunReport run;
  std::optional<DriverStop::Kind> stopped;  ///< none: the driver has come to an end of a plan
  std::string reason;                       ///< of the stop
  /// Why the journal does not end with the verdict; empty: it does, or there is none. A driver that
  /// was not at the end of the plan then was stopped.
  std::string not_noted = {};
  std::uint64_t actions = 0;  ///< begun
  std::uint64_t messages = 0;
  double seconds = 0;        ///< from the start to the end [s]
  double waited = 0;         ///< of these, for the driver [s]
  double between = 0;        ///< of these, from its answers to what it was told next [s]
  double most_tracking = 0;  ///< largest deviation from the plan that it said [rad, length]

  /// The goal is reached, and nothing on the way was wrong. What could not be noted of that is
  /// looked at apart.
  [[nodiscard]] bool good() const { return !stopped && run.good(); }
};

/// Carries out a plan by a robot driver, which is asked for what is sensed. Where that turns out as
/// the plan has no branch for, it is planned again from what is known then. A plan, the new ones
/// too, is told to the driver only after `plan::check` has found that it holds, and every motion
/// begins where the motion before has ended: nothing is moved that is not certified.
///
/// @param model  of the task.
/// @param request  outcomes in it are not looked at
/// @throws Error{InvalidArgument} for a task without a scene, and a plan whose contacts are those
/// of
///   a library of others; as RobotDriver, exact_cell, Simulation and plan::run_and_replan
DriveReport drive_plan(const PlanningTask& task, const plan::Model& model, const plan::Plan& plan,
                       const PlanRunRequest& request, const DriverOptions& driver);

}  // namespace kaboum::execution
