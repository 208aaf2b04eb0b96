// kaboum-move: paths of a robot of a scene, certified free at every instant, and their execution.
#include <kaboum/base/error.h>
#include <kaboum/motion/roadmap.h>
#include <kaboum/world/gripper.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "common/cli.h"
#include "common/result_files.h"
#include "files.h"
#include "request.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using motion::PathAnswer;
using Outcome = PathAnswer::Outcome;
using tools::MoveOptions;

/// The roadmap of a file; of none, one that is made and written there.
motion::Roadmap roadmap_of(const MoveOptions& o, const motion::PathFinder& finder,
                           const motion::PathOptions& options) {
  if (std::filesystem::exists(o.roadmap)) {
    const std::vector<char> bytes = io::read_file(o.roadmap);
    return motion::Roadmap::from_json({bytes.data(), bytes.size()}, o.roadmap, finder);
  }
  motion::RoadmapOptions made;
  made.seed = options.seed;
  made.check = options.check;
  motion::Roadmap out(finder, made);
  io::write_file(o.roadmap, out.to_json());
  tools::log(o.common.quiet, "roadmap of " + std::to_string(out.nodes()) + " nodes and " +
                                 std::to_string(out.edges()) + " edges: " + o.roadmap);
  return out;
}

int move(const MoveOptions& o) {
  if (o.degrees && motion::message_format(o.trajectory))
    throw Error(ErrorCode::InvalidArgument,
                "--degrees: a JointTrajectory is in radians; give --trajectory a name that ends "
                "with .csv");
  const tools::MoveRequest r = tools::read_request(o);
  std::vector<std::string> inputs = r.scene.inputs;
  inputs.insert(inputs.end(), {o.start, o.goals});
  tools::require_apart({{"--output", o.output},
                        {"--trajectory", o.trajectory},
                        {"--roadmap", o.roadmap},
                        {"--report", o.common.report}},
                       inputs);
  for (const std::string& note : r.notes) tools::log(o.common.quiet, note);
  if (r.goals.empty()) {
    for (const std::string& why : r.unreached) std::cerr << "kaboum-move: " << why << '\n';
    tools::Json report = tools::answer_json(r, {}, o);
    report["outcome"] = "goal out of reach";
    report["unreached"] = r.unreached;
    tools::write_report(o.common, "kaboum-move", report);
    return r.all_known ? tools::kNo : tools::kLimit;
  }
  const world::Checker checker(r.scene.world);
  const PathAnswer answer = [&] {
    tools::Progress progress(o.common.quiet);
    motion::PathOptions options = o.search;
    options.constraints = r.constraints;
    options.check.progress = [&](const std::string& stage) { progress.show(stage); };
    const world::WorldState state = initial_state(r.scene.world);
    // Fingers that hold something stay, and stop where they touch.
    options.still = world::holding_joints(r.robot, state.attachments);
    options.check.around = r.around;
    if (o.roadmap.empty()) return find_path(checker, state, r.robot, r.start, r.goals, options);
    const motion::PathFinder finder(checker, state, r.robot);
    return roadmap_of(o, finder, options).find(finder, r.start, r.goals, options);
  }();
  tools::Json report = tools::answer_json(r, answer, o);
  if (!r.notes.empty()) report["notes"] = r.notes;
  if (answer.outcome != Outcome::Found) {
    std::cerr << "kaboum-move: " << tools::reason(r, answer) << '\n';
    tools::write_report(o.common, "kaboum-move", report);
    return tools::exit_code(r, answer);
  }
  const tools::WrittenPath written = tools::write_path(r, answer.path, o, checker);
  report["waypoints"] = written.path;
  std::optional<tools::Execution> execution;
  if (!o.trajectory.empty()) {
    execution = tools::execute(r, written.path, o, checker);
    report["trajectory"] = execution->report;
  }
  report["output_angles"] = o.degrees ? "degrees" : "radians";
  report["output"] = o.output;
  tools::write_together(
      {{o.trajectory, [&] { io::write_file(o.trajectory, execution->text); }},
       {o.common.report, [&] { tools::write_report(o.common, "kaboum-move", report); }},
       {o.output, [&] { io::write_file(o.output, written.csv); }}});
  tools::log(
      o.common.quiet,
      std::to_string(answer.path.size()) + " waypoints" + (answer.straight ? ", straight" : "") +
          ", free at every instant" +
          (o.margin.margins.empty() ? "" : ", with margins kept: " + words_of(o.margin)) +
          (r.goals.size() > 1 ? "; to goal " + std::to_string(r.numbers[answer.goal]) : "") +
          (r.constraints.empty() ? "" : "; kept: " + words_of(r.constraints, answer.deviations)));
  if (execution) tools::log(o.common.quiet, execution->summary);
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
  return tools::run(app, argc, argv, [&] { return move(options); });
}
