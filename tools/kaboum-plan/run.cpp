// kaboum-plan run: every branch, or one, of a plan among exact meshes.

#include "run.h"

#include <kaboum/base/error.h>
#include <kaboum/execution/drive_plan.h>
#include <kaboum/execution/run_page.h>
#include <kaboum/execution/task_options.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <exception>
#include <functional>
#include <iostream>
#include <optional>
#include <vector>

#include "common/files.h"
#include "common/request_options.h"
#include "input.h"
#include "page.h"

namespace kaboum::tools {
namespace {

/// "all", "seed:N", or a JSON file of outcomes.
plan::RunOptions outcomes_of(const std::string& outcomes) {
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
          {"most_jerk", r.most_jerk},
          {"blends", r.blends},
          {"problems", r.problems}};
}

Json driver_json(const execution::DriveReport& r) {
  const execution::ExecutedReport& e = r.run.simulation.executed;
  const bool at_end = r.run.plans.complete();
  return {{"executed",
           {{"motions", e.motions},
            {"samples", e.samples},
            {"collisions", e.collisions},
            {"longest_gap", e.longest_gap},
            {"most_strayed", e.most_strayed},
            {"margin", e.margin}}},
          {"end", r.stopped ? execution::name_of(*r.stopped)
                  : at_end  ? "goal"
                            : "no plan"},
          {"reason", r.reason},
          {"actions", r.actions},
          {"messages", r.messages},
          {"most_tracking", r.most_tracking},
          {"wall_seconds", r.seconds},
          {"wall_seconds_waited", r.waited},
          {"wall_seconds_between", r.between}};
}

/// Whether a robot's program, or the journal of one, carries the plan out.
bool is_driven(const PlanOptions& o) {
  return !o.driver.command.empty() || !o.driver.replayed.empty();
}

void require_driver_meaning(const PlanOptions& o) {
  const bool drives = is_driven(o);
  if (!o.driver.command.empty() && !o.driver.replayed.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--robot moves a robot, --replay-journal repeats a run without: give one of them");
  if (drives && o.stated.contains("outcomes"))
    throw Error(ErrorCode::InvalidArgument, "--outcomes: the robot senses them");
  if (drives && !o.trajectories.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--trajectories: the robot is told them; --journal has them");
  for (const char* name :
       {"journal", "robot-timeout", "robot-rate", "robot-tracking", "robot-retries", "page"})
    if (!drives && o.stated.contains(name))
      throw Error(ErrorCode::InvalidArgument,
                  "--" + std::string(name) + " is of a robot's program; give --robot COMMAND");
  if (!drives && !o.live.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--live is of a robot's program; give --robot COMMAND (show --html plays a plan)");
  if (o.live.empty() && o.stated.contains("live-linger"))
    throw Error(ErrorCode::InvalidArgument, "--live-linger is of --live");
}

/// The port of --live; 0: a free one.
std::uint16_t live_port(const PlanOptions& o) {
  std::uint16_t port = 0;
  const char *begin = o.live.data(), *end = begin + o.live.size();
  const auto [stop, error] = std::from_chars(begin, end, port);
  if (error != std::errc() || stop != end)
    throw Error(ErrorCode::InvalidArgument,
                "--live: expected a port from 0 to 65535, not '" + o.live + "'");
  return port;
}

/// The page of a run, for browsers that follow it and as a file.
class Seen {
 public:
  Seen(const PlanOptions& o, const execution::PlanningTask& task) : o_(o), task_(task) {
    if (o.live.empty()) return;
    live_.emplace(task.scene()->world, task.files().scene, live_port(o), o.run.packages);
    for (const std::string& note : live_->notes()) log(o.common.quiet, note);
    std::cerr << "kaboum-plan: the run is shown at " << live_->address() << std::endl;
  }

  /// Who is told the lines of the journal; empty: nobody.
  std::function<void(const std::string&)> noted() {
    if (!live_ && o_.run_page.empty()) return {};
    return [this](const std::string& line) {
      if (live_) live_->note(line);
      if (!o_.run_page.empty()) lines_.push_back(line);
    };
  }

  /// Shows the rest where the run ends with an exception, too.
  ~Seen() {
    if (ended_) return;
    try {
      end();
    } catch (const std::exception& error) {
      std::cerr << "kaboum-plan: the run was not shown to its end: " << error.what() << '\n';
    }
  }
  Seen(const Seen&) = delete;
  Seen& operator=(const Seen&) = delete;

  /// When all is said. Browsers get what they do not have yet, for a second.
  void end() {
    ended_ = true;
    std::exception_ptr failed;
    if (!o_.run_page.empty() && !lines_.empty()) try {
        const execution::PlanPage page =
            execution::run_page(task_.scene()->world, task_.files().scene, lines_, o_.run.packages);
        for (const std::string& note : page.notes) log(o_.common.quiet, note);
        io::write_file(o_.run_page, page.html);
      } catch (...) {
        failed = std::current_exception();
      }
    if (live_) {
      live_->finish(1, o_.live_linger);
      if (const std::string why = live_->failure(); !why.empty())
        std::cerr << "kaboum-plan: the run was not shown to its end: " << why << '\n';
    }
    if (failed) std::rethrow_exception(failed);
  }

 private:
  const PlanOptions& o_;
  const execution::PlanningTask& task_;
  std::optional<execution::LiveRun> live_;
  std::vector<std::string> lines_;
  bool ended_ = false;
};

}  // namespace

CLI::App* add_run_command(CLI::App& app, PlanOptions& o) {
  CLI::App* r = app.add_subcommand(
      "run",
      "Carry out a plan in simulation, or by a robot's program, and judge every sample by exact "
      "meshes");
  add_inputs(*r, o);
  add_problem(*r, o);
  add_scene(*r, o);
  r->add_option("--plan", o.plan, "The plan to carry out, or -")->required()->type_name("FILE");
  r->add_option("--outcomes", o.outcomes,
                "Without a robot: how sensing turns out: all: every branch; seed:N: one, at "
                "random; a JSON file "
                "{\"isSpillable(o1)\": true, ...}: as it says")
      ->capture_default_str()
      ->type_name("all|seed:N|FILE")
      ->each([&o](const std::string&) { o.stated.insert("outcomes"); });
  add_request_options(*r, execution::run_options(), o.run, o.stated);
  add_request_options(*r, execution::driver_options(), o.driver, o.stated);
  r->add_flag("--live{0}", o.live,
              "Show the run in a browser on this machine while it goes on: serve a page at this "
              "port of 127.0.0.1, 0 is a free one, and print its address (docs/pages.md#runs)")
      ->type_name("PORT");
  r->add_option("--live-linger", o.live_linger,
                "Serve that page for so long after the run [0; browsers that follow have a second "
                "to get the rest]")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("SECONDS")
      ->each([&o](const std::string&) { o.stated.insert("live-linger"); });
  r->add_option("--page", o.run_page, "Write that page as a file when the run has ended")
      ->check(page_name())
      ->type_name("FILE")
      ->each([&o](const std::string&) { o.stated.insert("page"); });
  r->add_option("--trajectories", o.trajectories,
                "Write each motion's samples into this folder, and what happens between them: "
                "plan.json, events.csv")
      ->type_name("DIR");
  add_common_options(*r, o.common);
  return r;
}

int run_plan(const PlanOptions& o) {
  require_driver_meaning(o);
  const bool drives = is_driven(o);
  execution::PlanRunRequest request = o.run;
  request.replan.run = outcomes_of(o.outcomes);
  request.replan.solve.algorithm = plan::Algorithm::Greedy;
  request.trajectories = o.trajectories;
  const execution::PlanningTask task = read_task(o);
  if (task.scene() == nullptr)
    throw Error(ErrorCode::InvalidArgument, "--scene is required: a plan is carried out in it");
  std::vector<std::string> inputs = task.scene()->inputs;
  for (const std::string& file : {o.plan, o.task.domain, o.task.problem, o.driver.replayed})
    if (!file.empty()) inputs.push_back(file);
  require_apart(
      {{"--report", o.common.report}, {"--journal", o.driver.journal}, {"--page", o.run_page}},
      inputs);
  const plan::Model model = task.load();
  const plan::Plan plan = read_plan_file(model, o);
  execution::DriveReport drive;
  Seen seen(o, task);
  execution::DriverOptions driver = o.driver;
  driver.noted = seen.noted();
  {
    Progress progress(o.common.quiet);
    request.simulation.progress = [&](const std::string& stage) { progress.show(stage); };
    if (drives)
      drive = execution::drive_plan(task, model, plan, request, driver);
    else
      drive.run = execution::run_plan(task, model, plan, request);
  }
  const execution::PlanRunReport& done = drive.run;
  for (const std::string& note : done.notes) log(o.common.quiet, note);
  const plan::RunSummary& summary = done.plans.run;
  const std::vector<plan::Replan>& replans = done.plans.replans;
  const execution::SimulationReport& r = done.simulation;
  Json report = report_json(r, summary);
  report["command"] = "run";
  report["scene"] = task.files().scene;
  if (drives) report["driver"] = driver_json(drive);
  if (!drive.not_noted.empty()) report["driver"]["not_noted"] = drive.not_noted;
  if (!drives) report["outcomes"] = o.outcomes;
  report["rate"] = o.run.simulation.motion.rate;
  report["triangles"] = done.triangles;
  report["notes"] = done.notes;
  report["replans"] = replans_json(replans);
  const bool good = drive.good();
  report["verdict"] = good ? "good" : "not good";
  if (!plan.not_certified.empty()) report["not_certified"] = plan.not_certified;
  if (const std::string pads = pads_of(task); !pads.empty() && plan.not_certified.empty())
    report["claim"] = pads;
  write_report(o.common, "kaboum-plan", report);
  for (const std::string& problem : r.problems) std::cerr << "kaboum-plan: " << problem << '\n';
  if (drive.stopped)
    std::cerr << "kaboum-plan: stopped after " << drive.actions
              << (drive.actions == 1 ? " action: " : " actions: ") << drive.reason << '\n';
  if (!o.common.quiet || !good)
    std::cout << (good ? "good: " : "not good: ") << summary.branches
              << (summary.branches == 1 ? " branch, " : " branches, ") << r.motions << " motions, "
              << r.samples << " samples, " << r.collisions << " collisions, " << r.limit_violations
              << " limit violations, " << r.jumps << " jumps"
              << (replans.empty() ? ""
                                  : ", planned again " + std::to_string(replans.size()) +
                                        (replans.size() == 1 ? " time" : " times"))
              << '\n';
  if (const execution::ExecutedReport& e = r.executed; e.samples > 0 && (!o.common.quiet || !good))
    std::cout << "as executed: " << e.motions << " motions, " << e.samples << " samples, "
              << e.collisions << " collisions; in these samples, at most " << e.longest_gap
              << " s apart, joints are within " << e.most_strayed
              << " of the trajectories, and points within " << e.margin << '\n';
  const int missing = say_missing(replans);
  if (!drive.not_noted.empty())
    std::cerr << "kaboum-plan: " << drive.not_noted << ": the journal lacks the end of the run\n";
  std::cout.flush();
  seen.end();
  if (!drive.not_noted.empty()) return kOutputFailed;
  if (!r.good() || drive.stopped) return kNo;
  return good || missing != kDone ? missing : kNo;
}

}  // namespace kaboum::tools
