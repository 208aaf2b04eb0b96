// Plans carried out in simulation, and planned again where sensing turns out otherwise.

#include <kaboum/base/error.h>
#include <kaboum/execution/run_plan.h>

#include <deque>
#include <memory>
#include <optional>

#include "timeline.h"

namespace kaboum::execution {
PlanRunReport run_plan(const PlanningTask& task, const plan::Model& model, const plan::Plan& plan,
                       const PlanRunRequest& request) {
  if (task.scene() == nullptr)
    throw Error(ErrorCode::InvalidArgument, "a plan is carried out in a scene; there is none");
  const world::World& world = task.scene()->world;
  PlanRunReport out;
  const judge::Cell cell = exact_cell(world, task.files().scene, request.packages, out.notes);
  out.triangles = cell.triangles();
  std::optional<Timeline> timeline;
  MotionSink sink;
  if (!request.trajectories.empty()) {
    timeline.emplace(world, request.trajectories, request.motion_format,
                     request.simulation.motion.rate);
    sink = [&](const plan::RunStep& step, std::size_t robot, const motion::Trajectory& motion) {
      timeline->add_motion(step.node, robot, motion);
    };
  }
  std::deque<Simulation> simulations;  // of each plan
  const plan::StepsOf steps = [&](const plan::Model& m, const plan::Plan& p) {
    const auto motions = std::make_shared<NodeMotions>(world, m, p, request.simulation);
    Simulation& simulation =
        simulations.emplace_back(world, cell, m, p, request.simulation, sink, motions);
    if (timeline) timeline->begin(m, p, motions);
    return [&](const plan::RunStep& step) {
      if (request.simulation.progress)
        request.simulation.progress("node " + std::to_string(step.node));
      simulation.carry_out(step);
      if (timeline) timeline->add(step);
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
  if (timeline) timeline->write(out.plans.replans);
  for (const Simulation& simulation : simulations) out.simulation += simulation.report();
  return out;
}

}  // namespace kaboum::execution
