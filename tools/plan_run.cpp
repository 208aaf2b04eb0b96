// kaboum-plan run: every branch, or one, of a plan among exact meshes.

#include "plan_run.h"

#include <kaboum/base/error.h>
#include <kaboum/execution/exact_cell.h>
#include <kaboum/execution/simulation.h>
#include <kaboum/io/mesh_io.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <iostream>

#include "plan_input.h"
#include "scene_file.h"

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
  const std::vector<char> bytes = io::read_file(outcomes);
  const Json given = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const auto fail = [&] {
    throw Error(ErrorCode::InvalidInput,
                outcomes +
                    ": expected a JSON object of outcomes, as {\"isSpillable(o1)\": true, "
                    "\"place(o2)\": \"shelf\"}");
  };
  if (!given.is_object()) fail();
  for (const auto& [name, value] : given.items()) {
    if (!value.is_boolean() && !value.is_string()) fail();
    out.given[name] = value.is_string()   ? value.get<std::string>()
                      : value.get<bool>() ? "true"
                                          : "false";
  }
  return out;
}

/// Writes a file for each motion: N-ROBOT.csv, in the order in which they are carried out.
execution::MotionSink csv_sink(const world::World& world, const std::string& folder) {
  if (folder.empty()) return {};
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::OutputFailed, folder + ": cannot be created: " + error.message());
  return [&world, folder, number = 0](const plan::RunStep& step, std::size_t robot,
                                      const motion::Trajectory& trajectory) mutable {
    char name[64];
    std::snprintf(name, sizeof name, "%05d-node%u-", ++number, step.node);
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
  const plan::RunOptions options = run_options(o.outcomes);
  const SceneFile scene = read_scene(o.scene);
  const plan::Model model = load_model(o);
  const plan::Plan plan = read_plan_file(model, o.plan);
  std::vector<std::string> notes;
  const judge::Cell cell = execution::exact_cell(scene.world, o.scene, o.packages, notes);
  for (const std::string& note : notes) log(o.common.quiet, note);
  execution::Simulation simulation(scene.world, cell, model, plan, simulation_options(o),
                                   csv_sink(scene.world, o.trajectories));
  const plan::RunSummary summary = plan::run(
      model, plan, options, [&](const plan::RunStep& step) { simulation.carry_out(step); });
  const execution::SimulationReport& r = simulation.report();
  Json report = report_json(r, summary);
  report["command"] = "run";
  report["scene"] = o.scene;
  report["outcomes"] = o.outcomes;
  report["rate"] = o.rate;
  report["triangles"] = cell.triangles();
  report["notes"] = notes;
  write_report(o.common, "kaboum-plan", report);
  for (const std::string& problem : r.problems) std::cerr << "kaboum-plan: " << problem << '\n';
  if (!o.common.quiet || !r.good())
    std::cout << (r.good() ? "good: " : "not good: ") << summary.branches
              << (summary.branches == 1 ? " branch, " : " branches, ") << r.motions << " motions, "
              << r.samples << " samples, " << r.collisions << " collisions, " << r.limit_violations
              << " limit violations, " << r.jumps << " jumps\n";
  return r.good() ? kDone : kNo;
}

}  // namespace kaboum::tools
