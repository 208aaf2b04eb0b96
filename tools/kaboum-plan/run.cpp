// kaboum-plan run: every branch, or one, of a plan among exact meshes.

#include "run.h"

#include <kaboum/base/error.h>
#include <kaboum/execution/exact_cell.h>
#include <kaboum/execution/simulation.h>
#include <kaboum/io/mesh_io.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <deque>
#include <filesystem>
#include <iostream>
#include <memory>

#include "common/scene_file.h"
#include "input.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

/// "all", "seed:N", or a JSON file of outcomes.
plan::RunOptions run_options(const std::string& outcomes) {
  plan::RunOptions out;
  if (outcomes == "all") return out;
  if (outcomes.starts_with("seed:")) {
    out.outcomes = plan::RunOptions::Outcomes::Random;
    const char *begin = outcomes.data() + 5, *end = outcomes.data() + outcomes.size();
    const auto [stop, error] = std::from_chars(begin, end, out.seed);
    if (error != std::errc() || stop != end)
      throw Error(ErrorCode::InvalidArgument,
                  "--outcomes: expected all, seed:N or a file, not '" + outcomes + "'");
    return out;
  }
  out.outcomes = plan::RunOptions::Outcomes::Given;
  out.given = read_outcomes(outcomes);
  return out;
}

/// Writes a file for each motion: N-ROBOT.csv, in the order in which they are carried out.
execution::MotionSink csv_sink(const world::World& world, const std::string& folder) {
  if (folder.empty()) return {};
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::OutputFailed, folder + ": cannot be created: " + error.message());
  // Every plan that is carried out counts on.
  return [&world, folder, number = std::make_shared<int>(0)](
             const plan::RunStep& step, std::size_t robot, const motion::Trajectory& trajectory) {
    char name[64];
    std::snprintf(name, sizeof name, "%05d-node%u-", ++*number, step.node);
    io::write_file(fs::path(folder) / (name + world.robots[robot].name + ".csv"),
                   to_csv(trajectory, world.robots[robot].kinematics));
  };
}

execution::SimulationOptions simulation_options(const PlanOptions& o) {
  execution::SimulationOptions out;
  out.rate = o.rate;
  out.acceleration = o.acceleration;
  if (o.time_optimal) out.profile = motion::Profile::Trapezoid;
  return out;
}

const char* name_of(plan::Outcome outcome) {
  switch (outcome) {
    case plan::Outcome::Solved:
      return "solved";
    case plan::Outcome::Unsolvable:
      return "unsolvable";
    case plan::Outcome::NotInferred:
      return "not inferred";
    case plan::Outcome::Limit:
      break;
  }
  return "limit";
}

Json replans_json(const std::vector<plan::Replan>& replans) {
  Json out = Json::array();
  for (const plan::Replan& r : replans)
    out.push_back({{"outcome", r.outcome},
                   {"actions_before", r.actions},
                   {"after_plan", r.after},
                   {"status", name_of(r.result)},
                   {"reason", r.reason},
                   {"nodes", r.nodes},
                   {"known_before", r.reached},
                   {"circle", r.circle},
                   {"wall_seconds", r.seconds}});
  return out;
}

/// The first that there is no plan for, in words; and the exit code.
int say_missing(const std::vector<plan::Replan>& replans) {
  for (const plan::Replan& r : replans) {
    if (r.result == plan::Outcome::Solved && !r.circle) continue;
    std::cerr << "kaboum-plan: no plan from where " << r.outcome << " was sensed, after "
              << r.actions << (r.actions == 1 ? " action: " : " actions: ") << r.reason << '\n';
    return r.circle || r.result == plan::Outcome::Unsolvable ? kNo
           : r.result == plan::Outcome::NotInferred          ? kNotInferred
                                                             : kLimit;
  }
  return kDone;
}

Json report_json(const execution::SimulationReport& r, const plan::RunSummary& summary) {
  return {{"branches", summary.branches},
          {"ends", summary.ends},
          {"states", summary.states},
          {"steps", r.steps},
          {"motions", r.motions},
          {"samples", r.samples},
          {"motion_s", r.seconds},
          {"collisions", r.collisions},
          {"limit_violations", r.limit_violations},
          {"jumps", r.jumps},
          {"most_velocity", r.most_velocity},
          {"most_acceleration", r.most_acceleration},
          {"problems", r.problems}};
}

}  // namespace

CLI::App* add_run_command(CLI::App& app, PlanOptions& o) {
  CLI::App* r = app.add_subcommand(
      "run", "Carry out a plan in simulation, and judge every sample by exact meshes");
  add_inputs(*r, o);
  add_problem(*r, o);
  add_scene(*r, o)->required();
  r->add_option("--plan", o.plan, "The plan to carry out, or -")->required()->type_name("FILE");
  r->add_option("--outcomes", o.outcomes,
                "How sensing turns out: all: every branch; seed:N: one, at random; a JSON file "
                "{\"isSpillable(o1)\": true, ...}: as it says")
      ->capture_default_str()
      ->type_name("all|seed:N|FILE");
  r->add_option(
       "--replan", o.replan,
       "How often it is planned again, at most, where sensing turns out as the plan has no "
       "branch for; 0: that is an error")
      ->capture_default_str()
      ->type_name("N");
  r->add_option("--timeout", o.timeout, "Longest time for each new plan [no limit]")
      ->check(number_from(1e-3, 1e9))
      ->type_name("S");
  r->add_option("--rate", o.rate, "Samples per second")
      ->check(number_from(1, 1e5))
      ->capture_default_str()
      ->type_name("HZ");
  r->add_option("--max-acceleration", o.acceleration, "Of all joints, per second squared")
      ->check(number_from(1e-3, 1e6))
      ->capture_default_str()
      ->type_name("X");
  r->add_flag("--time-optimal", o.time_optimal,
              "As fast as velocities and accelerations allow, which then jump, instead of by "
              "quintic polynomials");
  r->add_option("--trajectories", o.trajectories,
                "Write each motion's samples into this folder, as CSV")
      ->type_name("DIR");
  r->add_option("--package-path", o.packages,
                "A package of package:// or a folder that holds it; may be repeated")
      ->type_name("DIR");
  add_common_options(*r, o.common);
  return r;
}

int run_plan(const PlanOptions& o) {
  plan::ReplanOptions options;
  options.run = run_options(o.outcomes);
  options.most = o.replan;
  options.solve.algorithm = plan::Algorithm::Greedy;
  options.solve.seed = o.common.seed;
  options.solve.timeout = o.timeout;
  const SceneFile scene = read_scene(o.scene);
  const plan::TaskTexts task = read_task(o);
  const plan::Model model =
      plan::load(task.domain, task.problem ? &*task.problem : nullptr, task.bindings);
  const plan::Plan plan = read_plan_file(model, o.plan);
  std::vector<std::string> notes;
  const judge::Cell cell = execution::exact_cell(scene.world, o.scene, o.packages, notes);
  for (const std::string& note : notes) log(o.common.quiet, note);
  const execution::MotionSink sink = csv_sink(scene.world, o.trajectories);
  std::deque<execution::Simulation> simulations;  // of each plan
  const plan::StepsOf steps = [&](const plan::Model& m, const plan::Plan& p) {
    execution::Simulation& simulation =
        simulations.emplace_back(scene.world, cell, m, p, simulation_options(o), sink);
    return [&simulation](const plan::RunStep& step) { simulation.carry_out(step); };
  };
  plan::ReplanSummary done;
  if (o.replan == 0) {
    done.run = plan::run(model, plan, options.run, steps(model, plan));
  } else {
    done = plan::run_and_replan(task, model, plan, options, steps);
  }
  const plan::RunSummary& summary = done.run;
  execution::SimulationReport r;
  for (const execution::Simulation& simulation : simulations) r += simulation.report();
  Json report = report_json(r, summary);
  report["command"] = "run";
  report["scene"] = o.scene;
  report["outcomes"] = o.outcomes;
  report["rate"] = o.rate;
  report["triangles"] = cell.triangles();
  report["notes"] = notes;
  report["replans"] = replans_json(done.replans);
  const bool good = r.good() && done.complete();
  report["verdict"] = good ? "good" : "not good";
  write_report(o.common, "kaboum-plan", report);
  for (const std::string& problem : r.problems) std::cerr << "kaboum-plan: " << problem << '\n';
  if (!o.common.quiet || !good)
    std::cout << (good ? "good: " : "not good: ") << summary.branches
              << (summary.branches == 1 ? " branch, " : " branches, ") << r.motions << " motions, "
              << r.samples << " samples, " << r.collisions << " collisions, " << r.limit_violations
              << " limit violations, " << r.jumps << " jumps"
              << (done.replans.empty() ? ""
                                       : ", planned again " + std::to_string(done.replans.size()) +
                                             (done.replans.size() == 1 ? " time" : " times"))
              << '\n';
  const int missing = say_missing(done.replans);
  return r.good() ? missing : kNo;
}

}  // namespace kaboum::tools
