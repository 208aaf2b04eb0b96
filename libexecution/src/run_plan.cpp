// Plans carried out in simulation, and planned again where sensing turns out otherwise.

#include <kaboum/base/error.h>
#include <kaboum/execution/run_plan.h>
#include <kaboum/io/mesh_io.h>

#include <cstdio>
#include <deque>
#include <memory>

namespace kaboum::execution {
namespace fs = std::filesystem;
namespace {

/// Writes a file for each motion: N-nodeM-ROBOT.csv, in the order in which they are carried out.
MotionSink csv_sink(const world::World& world, const fs::path& folder) {
  if (folder.empty()) return {};
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::OutputFailed,
                folder.string() + ": cannot be created: " + error.message());
  // Every plan that is carried out counts on.
  return [&world, folder, number = std::make_shared<int>(0)](
             const plan::RunStep& step, std::size_t robot, const motion::Trajectory& trajectory) {
    char name[64];
    std::snprintf(name, sizeof name, "%05d-node%u-", ++*number, step.node);
    io::write_file(folder / (name + world.robots[robot].name + ".csv"),
                   to_csv(trajectory, world.robots[robot].kinematics));
  };
}

}  // namespace

PlanRunReport run_plan(const PlanningTask& task, const plan::Model& model, const plan::Plan& plan,
                       const PlanRunRequest& request) {
  if (task.scene() == nullptr)
    throw Error(ErrorCode::InvalidArgument, "a plan is carried out in a scene; there is none");
  const world::World& world = task.scene()->world;
  PlanRunReport out;
  const judge::Cell cell = exact_cell(world, task.files().scene, request.packages, out.notes);
  out.triangles = cell.triangles();
  const MotionSink sink = csv_sink(world, request.trajectories);
  std::deque<Simulation> simulations;  // of each plan
  const plan::StepsOf steps = [&](const plan::Model& m, const plan::Plan& p) {
    Simulation& simulation = simulations.emplace_back(world, cell, m, p, request.simulation, sink);
    return [&](const plan::RunStep& step) {
      if (request.simulation.progress)
        request.simulation.progress("node " + std::to_string(step.node));
      simulation.carry_out(step);
    };
  };
  if (request.replan.most == 0) {
    out.plans.run = plan::run(model, plan, request.replan.run, steps(model, plan));
  } else {
    plan::ReplanOptions options = request.replan;
    if (request.simulation.progress && !options.solve.progress)
      options.solve.progress = [&](const plan::Statistics& s) {
        request.simulation.progress("planning again: " + std::to_string(s.expanded) +
                                    " states expanded");
      };
    out.plans = plan::run_and_replan(task.texts(), model, plan, options, steps);
  }
  for (const Simulation& simulation : simulations) out.simulation += simulation.report();
  return out;
}

}  // namespace kaboum::execution
