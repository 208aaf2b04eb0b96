// The program kaboum-check: whether a robot of a scene is free, at configurations or during a
// motion.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/page/world_picture.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/robot/path_options.h>
#include <kaboum/world/check_options.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/scene.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <sstream>

#include "batch.h"
#include "cloud.h"
#include "common/check_report.h"
#include "engine.h"
#include "inside.h"
#include "motions.h"
#include "options.h"

namespace {

using namespace kaboum;  // the tool's own names are few

/// The result: with --quiet, exit code and report have it.
void say(const tools::CheckOptions& o, const std::string& line) {
  if (!o.common.quiet) std::cout << line << '\n';
}

/// End of what is said of what is free.
std::string kept_apart(const tools::CheckOptions& o) {
  const std::string margins = words_of(o.margin);
  return margins.empty() ? "" : ", with margins kept: " + margins;
}

/// End of what is said of a motion that is free.
std::string between_words(const tools::CheckOptions& o) {
  return o.between == tools::kStraight ? "" : " of the " + o.between + " polynomials";
}

/// What of stated margins "free" of a configuration leaves open; empty: nothing.
std::string not_looked_at(const tools::CheckOptions& o, const world::World& world) {
  const bool all =
      o.state.resting || words_of(o.margin).empty() ||
      std::ranges::count_if(world.attachments, [](const auto& held) { return !held; }) < 2;
  return all ? "" : "; objects that rest are not looked at in pairs (--resting does)";
}

std::vector<double> configuration_at(const robot::Path& path, std::size_t segment, double share) {
  const std::vector<double>&from = path[segment],
        &to = path[std::min(segment + 1, path.size() - 1)];
  std::vector<double> out = from;
  for (std::size_t i = 0; i < from.size(); ++i) out[i] += share * (to[i] - from[i]);
  return out;
}

using Constraints = std::vector<motion::PathConstraint>;

/// Whether a robot's motion keeps what is asked for, and what it carries upright: an exit code.
/// @param which  of the motions
int check_kept(const tools::CheckOptions& o, const world::World& world,
               const tools::StatedMotions& motions, std::size_t which,
               const Constraints& constraints, tools::Json& report) {
  const world::RobotPath& motion = motions.paths[which];
  const world::RobotModel& robot = world.robots[motion.robot];
  const robot::Path& path = motion.path;
  if (constraints.empty()) return tools::kDone;
  motion::ConstraintAnswer answer = [&] {
    tools::Progress progress(o.common.quiet);
    world::MotionOptions told = o.motion;
    if (motions.curve) told.around = motion.around;
    told.progress = [&](const std::string& stage) { progress.show(stage); };
    return check_constraints(robot, path, constraints, told);
  }();
  using Outcome = motion::ConstraintAnswer::Outcome;
  report = {{"answer", name_of(answer.outcome)},
            {"instants", answer.instants},
            {"constraints", tools::Json::array()}};
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    report["constraints"].push_back(tools::to_json(robot.kinematics, constraints[i]));
    if (answer.outcome == Outcome::Kept) report["constraints"].back()["used"] = answer.parts[i];
  }
  if (answer.outcome == Outcome::Kept) {
    say(o, "kept at every instant: " + words_of(constraints, answer.parts));
    return tools::kDone;
  }
  motions.place(answer.segment, answer.share);
  report["segment"] = answer.segment;
  report["share"] = answer.share;
  report["deviation"] = answer.deviation;
  std::ostringstream line;
  line << (answer.outcome == Outcome::Broken ? "not kept: " : "undecided: ")
       << describe(answer, constraints);
  if (path.size() > 1)
    line << ", " << 100 * answer.share << " % of the way from waypoint " << answer.segment + 1
         << " to " << answer.segment + 2;
  say(o, line.str());
  return answer.outcome == Outcome::Broken ? tools::kNo : tools::kLimit;
}

/// The worse of two exit codes of answers: no, undecided, yes.
int worse(int a, int b) {
  if (a == tools::kNo || b == tools::kNo) return tools::kNo;
  return a == tools::kDone ? b : a;
}

/// What is asked of one robot that moves alone: where it stays, and what it keeps; of several, what
/// each carries upright.
int check_wishes(const tools::CheckOptions& o, const world::Checker& checker,
                 const tools::StatedMotions& motions, const std::vector<Constraints>& constraints,
                 tools::Json& report) {
  const world::World& world = checker.world();
  const std::vector<world::RobotPath>& paths = motions.paths;
  int code = tools::kDone;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    tools::Json kept;
    code = worse(code, check_kept(o, world, motions, i, constraints[i], kept));
    if (kept.is_null()) continue;
    if (paths.size() == 1)
      report["kept"] = std::move(kept);
    else
      report["kept"][world.robots[paths[i].robot].name] = std::move(kept);
  }
  if (paths.size() > 1) return code;
  const collide::Inclusion inside = tools::decide_inside(
      checker, initial_state(world), paths.front().robot, paths.front().path, o.motion,
      tools::parse_inside(world, o.inside), [&](const std::string& line) { say(o, line); }, report);
  using collide::Inclusion;
  return worse(code, inside == Inclusion::NotIncluded ? tools::kNo
                     : inside == Inclusion::Undecided ? tools::kLimit
                                                      : tools::kDone);
}

/// When a share of a segment is reached. @pre there are times
double time_at(const std::vector<double>& times, std::size_t segment, double share) {
  const double from = times[segment], to = times[std::min(segment + 1, times.size() - 1)];
  return from + share * (to - from);
}

/// End of what is said of a motion whose file has times.
std::string words_of_times(const world::MotionAnswer& answer, const std::vector<double>& times) {
  if (times.empty() || answer.outcome == world::MotionAnswer::Outcome::Free) return "";
  std::ostringstream out;
  out << " (free until " << time_at(times, answer.segment, answer.share) << " s";
  if (answer.contact)
    out << ", in contact at " << time_at(times, answer.contact_segment, answer.contact_share)
        << " s";
  return out.str() + ")";
}

/// What joints do between waypoints, where they do not go straight.
void say_curve(const tools::CheckOptions& o, const world::World& world,
               const tools::StatedMotions& motions, tools::Json& report) {
  if (!motions.curve) return;
  tools::Json& curve =
      report["curve"] = {{"between", o.between}, {"lines", motions.curve->points.size() - 1}};
  for (const world::RobotPath& p : motions.paths)
    curve["room"][world.robots[p.robot].name] = p.around;
}

int check_paths(const tools::CheckOptions& o, const world::SceneFile& scene,
                const tools::StatedMotions& motions, tools::Json& report) {
  const std::vector<world::RobotPath>& paths = motions.paths;
  const std::vector<double>& times = motions.times;
  const world::Checker checker(scene.world);
  // Errors come first.
  static_cast<void>(tools::parse_inside(scene.world, o.inside));
  std::vector<Constraints> constraints;
  constraints.reserve(paths.size());
  for (const world::RobotPath& p : paths)
    constraints.push_back(constraints_of(scene.world, initial_state(scene.world), p.robot,
                                         p.path.front(), {&p.path.back(), 1}, o.keep));
  world::MotionAnswer answer = [&] {
    tools::Progress progress(o.common.quiet);
    world::MotionOptions told = o.motion;
    told.progress = [&](const std::string& stage) { progress.show(stage); };
    const world::WorldState state = initial_state(scene.world);
    if (paths.size() > 1) return check_motions(checker, state, paths, told);
    told.around = paths[0].around;
    return check_motion(checker, state, paths[0].robot, paths[0].path, told);
  }();
  report["waypoints"] = motions.waypoints;
  say_curve(o, scene.world, motions, report);
  report["resolution"] = o.motion.resolution;
  world::WorldState at = initial_state(scene.world);
  for (const world::RobotPath& p : paths) at.q[p.robot] = p.path.back();
  std::vector<world::Contact> contacts;
  if (answer.contact) {
    for (const world::RobotPath& p : paths)
      at.q[p.robot] = configuration_at(p.path, answer.contact_segment, answer.contact_share);
    if (answer.meets) {
      world::Scratch scratch;
      checker.measure_depth(*answer.contact, at, scratch);
    }
    contacts.push_back(*answer.contact);
  }
  motions.place(answer.segment, answer.share);
  motions.place(answer.contact_segment, answer.contact_share);
  report["motion"] = tools::to_json(scene.world, answer);
  if (!times.empty() && report["motion"].contains("free_until"))
    report["motion"]["free_until"]["time"] = time_at(times, answer.segment, answer.share);
  if (!times.empty() && report["motion"].contains("contact"))
    report["motion"]["contact"]["time"] =
        time_at(times, answer.contact_segment, answer.contact_share);
  say(o,
      tools::describe(scene.world, answer) + words_of_times(answer, times) +
          (answer.outcome == world::MotionAnswer::Outcome::Free ? between_words(o) + kept_apart(o)
                                                                : ""));
  if (!o.preview.empty()) io::write_file(o.preview, page::picture_of(checker, at, contacts));
  const int wishes = check_wishes(o, checker, motions, constraints, report);
  using Outcome = world::MotionAnswer::Outcome;
  report["answer"] = answer.outcome == Outcome::Free                             ? "free"
                     : answer.outcome == Outcome::Undecided                      ? "undecided"
                     : answer.contact && answer.contact->certain && answer.meets ? "colliding"
                                                                                 : "within epsilon";
  return worse(wishes, answer.outcome == Outcome::Free        ? tools::kDone
                       : answer.outcome == Outcome::Undecided ? tools::kLimit
                                                              : tools::kNo);
}

/// Whether robots that hold something are free wherever their fingers stop within what the grasps
/// allow; nullopt: no finger may be elsewhere than it is.
/// @param what  of the state, in messages
std::optional<world::MotionAnswer> check_fingers(const tools::CheckOptions& o,
                                                 const world::Checker& checker,
                                                 const world::WorldState& state,
                                                 const std::string& what) {
  std::vector<world::RobotPath> at;
  for (std::size_t robot = 0; robot < state.q.size(); ++robot) {
    const robot::Path here{state.q[robot]};
    try {
      std::vector<double> around =
          world::finger_room_along(checker.world(), robot, state.attachments, here, what);
      if (!around.empty()) at.push_back({robot, here, std::move(around)});
    } catch (const Error& error) {
      throw Error(ErrorCode::InvalidInput, error.what());
    }
  }
  if (at.empty()) return std::nullopt;
  return check_motions(checker, state, at, o.motion);
}

/// What is not free for certain where fingers may stop, of robots that stand: a motion without a
/// way.
void say_fingers(const tools::CheckOptions& o, const world::World& world, const std::string& before,
                 const world::MotionAnswer& answer, tools::Json& report) {
  std::string line = before + "not free for certain wherever fingers stop: ";
  if (answer.contact)
    line += (answer.meets ? "" : "nearly: ") + tools::describe(world, *answer.contact);
  else
    line += "undecided after " + std::to_string(answer.intervals) + " intervals";
  say(o, line);
  tools::Json& fingers = report["fingers"] = tools::to_json(world, answer);
  fingers.erase("free_until");
  for (const char* place : {"waypoint", "share"})
    if (answer.contact) fingers["contact"].erase(place);
}

int check_states(const tools::CheckOptions& o, const world::SceneFile& scene,
                 std::optional<std::size_t> robot, const robot::Path& values, tools::Json& report) {
  const world::Checker checker(scene.world);
  world::Scratch scratch;
  bool free = true, certain = false, drawn = false;
  const std::vector<tools::Inside> wanted = tools::parse_inside(scene.world, o.inside);
  using collide::Inclusion;
  Inclusion inside = Inclusion::Included;
  tools::Json states = tools::Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    world::WorldState state = initial_state(scene.world);
    if (robot) state.q[*robot] = values[i];
    std::vector<world::Contact> contacts = checker.find_contacts(state, scratch, o.state);
    for (world::Contact& contact : contacts) checker.measure_depth(contact, state, scratch);
    tools::Json one = {{"free", contacts.empty()}, {"contacts", tools::Json::array()}};
    const std::string before =
        values.size() > 1 ? "configuration " + std::to_string(i + 1) + ": " : "";
    const auto fingers = check_fingers(
        o, checker, state,
        o.configurations.empty() ? "--configuration"
                                 : o.configurations + ": configuration " + std::to_string(i + 1));
    if (fingers && fingers->outcome != world::MotionAnswer::Outcome::Free && contacts.empty()) {
      free = one["free"] = false;
      say_fingers(o, scene.world, before, *fingers, one);
    } else if (contacts.empty()) {
      say(o, before + "free" + kept_apart(o) + not_looked_at(o, scene.world));
    }
    for (const world::Contact& contact : contacts) {
      free = false;
      certain = certain || contact.certain;
      one["contacts"].push_back(tools::to_json(scene.world, contact));
      say(o, before + tools::describe(scene.world, contact));
    }
    const Inclusion here = tools::decide_inside(
        checker, state, wanted, before, [&](const std::string& line) { say(o, line); }, one);
    if (inside != Inclusion::NotIncluded && here != Inclusion::Included) inside = here;
    if (!o.preview.empty() && !drawn && (!contacts.empty() || i + 1 == values.size())) {
      io::write_file(o.preview, page::picture_of(checker, state, contacts));
      drawn = true;
    }
    if (o.distance) {
      if (const auto nearest = checker.find_nearest(state, scratch, o.state)) {
        const auto& [items, clearance] = *nearest;
        one["distance"] = {
            {"lower", clearance.lower},
            {"upper", clearance.upper},
            {"pair", {scene.world.name_of(items[0]), scene.world.name_of(items[1])}}};
        std::ostringstream line;
        line << before << "nearest: " << scene.world.name_of(items[0]) << " and "
             << scene.world.name_of(items[1]) << ", sets ";
        if (clearance.upper < 0)
          line << -clearance.upper << " to " << -clearance.lower << " deep in each other";
        else
          line << clearance.lower << " to " << clearance.upper << " apart";
        say(o, line.str());
      }
    }
    states.push_back(std::move(one));
  }
  report["configurations"] = std::move(states);
  report["answer"] = free ? "free" : certain ? "colliding" : "within epsilon";
  if (!free || inside == Inclusion::NotIncluded) return tools::kNo;
  return inside == Inclusion::Included ? tools::kDone : tools::kLimit;
}

/// Polynomials between waypoints are decided by own predicates, and regions on straight lines.
void require_curve_meaning(const tools::CheckOptions& o) {
  if (o.between == tools::kStraight) return;
  if (!o.inside.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--inside is decided on straight lines between waypoints: leave out --between");
  if (o.engine.library != engines::Library::Own)
    throw Error(ErrorCode::InvalidArgument,
                "--engine is asked at samples of straight lines: leave out --between");
}

int check(const tools::CheckOptions& o) {
  if (!o.paths.empty() && (o.state.resting || o.distance))
    throw Error(ErrorCode::InvalidArgument, "--resting and --distance are for configurations");
  require_curve_meaning(o);
  world::SceneFile scene = world::read_scene(o.scene);
  std::vector<std::string> notes = scene.notes;
  tools::Json report = {{"scene", {{"file", o.scene}, {"sha256", scene.sha256}}}};
  tools::add_clouds(o, scene.world, notes, report);
  scene.world.margins = world::margins_of(scene.world, o.margin);
  const std::vector<tools::StatedPath> stated = tools::stated_paths(o, scene.world);
  std::vector<std::string> inputs = scene.inputs;
  inputs.push_back(o.configurations);
  inputs.push_back(o.batch);
  inputs.insert(inputs.end(), o.clouds.begin(), o.clouds.end());
  for (const tools::StatedPath& path : stated) inputs.push_back(path.file);
  tools::require_apart(
      {{"--report", o.common.report}, {"--preview", o.preview}, {"--verdicts", o.verdicts}},
      inputs);
  std::optional<std::size_t> robot;
  const bool moves =
      !o.paths.empty() || !o.configuration.empty() || !o.configurations.empty() || !o.batch.empty();
  if (stated.size() <= 1 && (moves || !o.robot.empty())) {
    const bool named = stated.size() == 1 && stated[0].robot;
    robot = named && o.robot.empty() ? *stated[0].robot : world::robot_named(scene.world, o.robot);
    if (named && robot != stated[0].robot)
      throw Error(ErrorCode::InvalidArgument, "--path names another robot than --robot");
    report["robot"] = scene.world.robots[*robot].name;
  }
  if (!robot)
    for (const tools::StatedPath& path : stated)
      report["robots"].push_back(scene.world.robots[*path.robot].name);
  const tools::StatedMotions motions = tools::read_motions(o, scene.world, stated, robot, notes);
  const std::vector<world::RobotPath>& paths = motions.paths;
  robot::Path values{{}};
  if (robot && paths.empty()) {
    const world::RobotModel& model = scene.world.robots[*robot];
    values = !o.batch.empty() ? robot::read_path(o.batch, model.kinematics, o.reading, notes)
             : !o.configurations.empty()
                 ? robot::read_path(o.configurations, model.kinematics, o.reading, notes)
             : !o.configuration.empty()
                 ? robot::parse_configuration(o.configuration, "--configuration", model.kinematics,
                                              o.reading)
                 : robot::Path{initial_state(scene.world).q[*robot]};
  }
  for (const std::string& note : notes) tools::log(o.common.quiet, note);
  const auto tell = [&](const std::string& line) { say(o, line); };
  const bool own = o.engine.library == engines::Library::Own;
  if (!own) report["engine"] = tools::engine_json(o);
  const int code =
      !o.batch.empty() ? tools::check_batch(o, scene, *robot, values, kept_apart(o), tell, report)
      : own            ? paths.empty() ? check_states(o, scene, robot, values, report)
                                       : check_paths(o, scene, motions, report)
                 : paths.empty() ? tools::check_states_by_engine(o, scene, robot, values, tell, report)
                       : tools::check_paths_by_engine(o, scene, paths, tell, report);
  if (!notes.empty()) report["notes"] = notes;
  if (!o.margin.margins.empty()) report["margins"] = words_of(o.margin);
  tools::write_report(o.common, "kaboum-check", report);
  return code;
}

/// Options that say how a motion or a configuration is meant, without one, would be ignored: the
/// answer would be that of another state than was meant.
void require_meaning(const tools::CheckOptions& o) {
  const auto require = [&](const OptionDescription& option, bool given, const char* others) {
    if (o.stated.contains(option.name) && !given)
      throw Error(ErrorCode::InvalidArgument,
                  "--" + option.name + " needs " + others +
                      "; without, what is looked at are the robots at home");
  };
  const bool moves = !o.paths.empty();
  const bool given =
      moves || !o.configuration.empty() || !o.configurations.empty() || !o.batch.empty();
  for (const auto& option : robot::path_options())
    require(option, given, "--path, --configuration, --configurations or --batch");
  for (const auto& option : world::motion_options())
    require(option, moves || !o.motions.empty(), "--path, or --batch with --motions");
  for (const auto& option : motion::keep_options()) require(option, moves, "--path");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Decides whether robots are free of collisions, at configurations or all along "
      "motions.",
      "kaboum-check"};
  tools::CheckOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    require_meaning(options);
    tools::require_engine_meaning(options);
    tools::require_batch_meaning(options);
    tools::require_cloud_meaning(options);
    return check(options);
  });
}
