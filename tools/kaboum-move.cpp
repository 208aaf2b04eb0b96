// kaboum-move: paths of a robot of a scene, certified free at every instant, and their execution.
#include <kaboum/base/error.h>
#include <kaboum/motion/find_path.h>
#include <kaboum/motion/trajectory.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path_file.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "check_report.h"
#include "cli.h"
#include "motion_options.h"
#include "move_options.h"
#include "scene_file.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using motion::PathAnswer;
using Outcome = PathAnswer::Outcome;
using tools::MoveOptions;

[[noreturn]] void usage(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

/// What is asked for.
struct Request {
  tools::SceneFile scene;
  std::size_t robot = 0;
  std::vector<double> start;
  robot::Path goals;
  std::vector<std::size_t> numbers;  ///< of the goals, as they were given, from 1
  std::vector<std::string> notes;

  [[nodiscard]] const world::RobotModel& model() const { return scene.world.robots[robot]; }
  [[nodiscard]] const robot::Robot& kinematics() const { return model().kinematics; }
};

/// "0,1.5,-2": a value per variable.
std::vector<double> configuration(const std::string& text, const char* option, const MoveOptions& o,
                                  const robot::Robot& robot) {
  try {
    robot::Path path = arrange(robot::parse_path_csv(text, option), robot, option, false, {});
    if (path.size() != 1) usage(std::string(option) + ": one configuration is expected");
    if (o.degrees) path = robot::from_degrees(std::move(path), robot);
    robot::require_within_limits(path, robot, option);
    return path.front();
  } catch (const Error& error) {
    usage(error.what());  // the command line's fault, no file's
  }
}

/// The goals of a file. Those beyond the joints' limits are left out with a note: others may do.
void add_goals(Request& r, robot::Path goals, const std::string& file) {
  const std::size_t given = r.goals.size();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (const auto bad = find_out_of_limits(r.kinematics(), goals[i])) {
      r.notes.push_back(file + ": goal " + std::to_string(i + 1) + " is left out: joint '" +
                        r.kinematics().variables[*bad].name + "' is outside its limits");
    } else {
      r.goals.push_back(std::move(goals[i]));
      r.numbers.push_back(given + i + 1);
    }
  }
  if (r.goals.empty())
    throw Error(ErrorCode::InvalidInput, file + ": all goals are outside the joints' limits");
}

Request read_request(const MoveOptions& o) {
  Request r;
  r.scene = tools::read_scene(o.scene);
  r.notes = r.scene.notes;
  r.robot = tools::robot_named(r.scene.world, o.robot);
  const robot::Robot& robot = r.kinematics();
  const auto read = [&](const std::string& file, bool limits) {
    return robot::read_path(file, robot, {limits, o.degrees, {}}, r.notes);
  };
  r.start = !o.start.empty()  ? read(o.start, true).back()
            : !o.from.empty() ? configuration(o.from, "--from", o, robot)
                              : r.model().home;
  for (const std::string& text : o.to) {
    r.goals.push_back(configuration(text, "--to", o, robot));
    r.numbers.push_back(r.goals.size());
  }
  if (!o.goals.empty()) add_goals(r, read(o.goals, false), o.goals);
  if (r.goals.empty()) usage("where to? Give --to Q1,Q2,… or --goals FILE");
  return r;
}

tools::Json blockers_json(const world::World& world, const PathAnswer& answer) {
  tools::Json out = tools::Json::array();
  for (const motion::Blocker& b : answer.blockers)
    out.push_back(
        {{"pair", {world.name_of(b.items[0]), world.name_of(b.items[1])}}, {"times", b.times}});
  return out;
}

tools::Json answer_json(const Request& r, const PathAnswer& answer, const MoveOptions& o) {
  const motion::Spent& s = answer.spent;
  tools::Json out = {{"scene", {{"file", o.scene}, {"sha256", r.scene.sha256}}},
                     {"robot", r.model().name},
                     {"outcome", name_of(answer.outcome)},
                     {"seed", o.common.seed},
                     {"start", r.start},
                     {"goals", r.goals.size()},
                     {"spent",
                      {{"work", s.work},
                       {"configurations", s.configurations},
                       {"motions", s.motions},
                       {"intervals", s.intervals},
                       {"samples", s.samples},
                       {"nodes", s.nodes}}},
                     {"blockers", blockers_json(r.scene.world, answer)}};
  if (answer.outcome == Outcome::Found) {
    out["goal"] = r.numbers[answer.goal];
    out["straight"] = answer.straight;
    out["waypoints"] = answer.path;
  }
  if (answer.contact) out["contact"] = tools::to_json(r.scene.world, *answer.contact);
  return out;
}

/// Why there is no path.
std::string reason(const Request& r, const PathAnswer& answer) {
  const world::World& world = r.scene.world;
  if (answer.outcome == Outcome::StartInContact)
    return "the start is not free: " + tools::describe(world, *answer.contact);
  if (answer.outcome == Outcome::GoalInContact)
    return std::string(r.goals.size() > 1 ? "no goal is free: " : "the goal is not free: ") +
           tools::describe(world, *answer.contact);
  std::string out = "no path found, which does not say that there is none: the search ended by ";
  out += answer.outcome == Outcome::WorkEnded    ? "--max-work"
         : answer.outcome == Outcome::NodesEnded ? "--max-nodes"
                                                 : "--timeout";
  if (!answer.blockers.empty()) {
    const motion::Blocker& b = answer.blockers.front();
    out += "; most often in the way: " + world.name_of(b.items[0]) + " and " +
           world.name_of(b.items[1]);
  }
  return out;
}

/// What was written, read as any program would.
robot::Path read_back(const std::string& text, const robot::Robot& robot) {
  return robot::arrange(robot::parse_path_csv(text, "the output"), robot, "the output");
}

/// Of a file of samples: more would take minutes to certify and gigabytes to write.
constexpr std::size_t kMostSamples = 5'000'000;

struct Execution {
  std::string csv;
  tools::Json report;
};

/// The samples as they are written are certified anew, with straight lines between them.
Execution execute(const Request& r, const PathAnswer& answer, const MoveOptions& o,
                  const world::Checker& checker) {
  const motion::SpeedLimits limits = tools::speed_limits(o, r.kinematics());
  const motion::Trajectory trajectory(
      answer.path, limits, o.rate,
      o.time_optimal ? motion::Profile::Trapezoid : motion::Profile::Quintic);
  if (trajectory.samples() > kMostSamples)
    throw Error(ErrorCode::LimitReached,
                "--trajectory: " + std::to_string(trajectory.samples()) + " samples in " +
                    std::to_string(trajectory.duration()) + " s, more than " +
                    std::to_string(kMostSamples) + ": give a lower --rate or higher limits");
  Execution out{to_csv(trajectory, r.kinematics()), {}};
  world::MotionOptions options;
  // Finer than for the path: what that has decided is not to be refused for a rounding.
  options.resolution = 1e-3 * tools::parse_length(o.resolution)->value;
  options.most_intervals = std::numeric_limits<std::size_t>::max();
  const world::MotionAnswer motion = check_motion(checker, initial_state(r.scene.world), r.robot,
                                                  read_back(out.csv, r.kinematics()), options);
  if (motion.outcome != world::MotionAnswer::Outcome::Free)
    throw Error(ErrorCode::LimitReached,
                "the samples pass too near to be certified: give a smaller --resolution (" +
                    tools::describe(r.scene.world, motion) + ")");
  out.report = {{"file", o.trajectory},
                {"rate", o.rate},
                {"samples", trajectory.samples()},
                {"max_velocity", limits.velocity},
                {"max_acceleration", limits.acceleration},
                {"seconds", trajectory.duration()}};
  return out;
}

motion::PathOptions path_options(const MoveOptions& o) {
  motion::PathOptions out;
  out.seed = o.common.seed;
  out.most_work = o.max_work;
  out.most_nodes = o.max_nodes;
  if (o.timeout > 0) out.most_seconds = o.timeout;
  out.shortcuts = o.shortcuts;
  out.check.resolution = tools::parse_length(o.resolution)->value;
  return out;
}

int move(const MoveOptions& o) {
  const Request r = read_request(o);
  std::vector<std::string> inputs = r.scene.inputs;
  inputs.insert(inputs.end(), {o.start, o.goals});
  tools::require_apart(
      {{"--output", o.output}, {"--trajectory", o.trajectory}, {"--report", o.common.report}},
      inputs);
  for (const std::string& note : r.notes) tools::log(o.common.quiet, note);
  const world::Checker checker(r.scene.world);
  const PathAnswer answer =
      find_path(checker, initial_state(r.scene.world), r.robot, r.start, r.goals, path_options(o));
  tools::Json report = answer_json(r, answer, o);
  if (!r.notes.empty()) report["notes"] = r.notes;
  if (answer.outcome != Outcome::Found) {
    std::cerr << "kaboum-move: " << reason(r, answer) << '\n';
    tools::write_report(o.common, "kaboum-move", report);
    return answer.contact ? tools::kNo : tools::kLimit;
  }
  const std::string csv = motion::to_csv(answer.path, r.kinematics());
  ensure(read_back(csv, r.kinematics()) == answer.path, "a path is written as another one");
  std::optional<Execution> execution;
  if (!o.trajectory.empty()) {
    execution = execute(r, answer, o, checker);
    report["trajectory"] = execution->report;
  }
  report["output"] = o.output;
  io::write_file(o.output, csv);
  if (execution) io::write_file(o.trajectory, execution->csv);
  tools::log(o.common.quiet,
             std::to_string(answer.path.size()) + " waypoints" +
                 (answer.straight ? ", straight" : "") + ", free at every instant" +
                 (r.goals.size() > 1 ? "; to goal " + std::to_string(r.numbers[answer.goal]) : ""));
  tools::write_report(o.common, "kaboum-move", report);
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Finds a path for a robot of a scene, certified free of contacts at every instant, and "
      "writes it as waypoints, or as samples over time.",
      "kaboum-move"};
  MoveOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    // As from a variable of the shell that is not set: what was meant is not known.
    for (const char* name :
         {"--robot", "--from", "--start", "--to", "--goals", "--output", "--trajectory"})
      if (app.count(name) > 0)
        for (const std::string& value : app.get_option(name)->results())
          if (value.empty()) usage(std::string(name) + ": the value is empty");
    return move(options);
  });
}
