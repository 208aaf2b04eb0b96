#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/regions.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include "check_report.h"
#include "cli.h"
#include "motion_options.h"
#include "scene_file.h"
#include "scene_picture.h"

namespace {

using namespace kaboum;  // the tool's own names are few

struct Options {
  std::string scene, robot, path, configuration, configurations, resolution = "1e-5", preview;
  std::vector<std::string> joints, inside;
  bool degrees = false, ignore_limits = false, resting = false, distance = false;
  std::size_t most_intervals = 1'000'000;
  tools::CommonOptions common;
};

void describe(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene, "Scene file (docs/scene.md)")->required();
  app.add_option("--robot", o.robot, "Which robot moves [the only one]")->type_name("NAME");
  auto* path = app.add_option("--path", o.path,
                              "Decide a whole motion, at every instant: waypoints, CSV or JSON")
                   ->type_name("FILE");
  auto* one = app.add_option("--configuration", o.configuration,
                             "Decide the robot at these joint values, separated by commas [home]")
                  ->type_name("Q1,Q2,…")
                  ->excludes(path);
  app.add_option("--configurations", o.configurations,
                 "Decide each line of a file of joint values, CSV or JSON")
      ->type_name("FILE")
      ->excludes(path)
      ->excludes(one);
  tools::add_joint_option(app, o.joints);
  tools::add_degrees_option(app, o.degrees);
  app.add_flag("--ignore-limits", o.ignore_limits, "Allow values outside the joints' limits");
  app.add_flag("--resting", o.resting, "Look at pairs of objects that rest, too (not with --path)");
  app.add_flag("--distance", o.distance, "Say how far apart the nearest pair is (not with --path)");
  app.add_option("--inside", o.inside,
                 "Decide as well whether an object, ROBOT/LINK or ROBOT lies in a region (not with "
                 "--path); may be repeated")
      ->type_name("NAME=REGION");
  app.add_option(
         "--preview", o.preview,
         "Write a picture (PNG): what is in contact is orange, the bodies that meet red; of "
         "a motion the instant of its contact, or its end; of several configurations the "
         "first that is not free")
      ->type_name("FILE");
  app.add_option("--resolution", o.resolution,
                 "How much nearer than epsilon bodies may come in a motion before it counts as "
                 "contact")
      ->check([](const std::string& s) {
        const auto length = tools::parse_length(s);
        return length && !length->percent ? std::string() : "must be a positive number";
      })
      ->capture_default_str()
      ->type_name("LENGTH");
  app.add_option("--max-intervals", o.most_intervals,
                 "Most stretches of time that are looked at; then the motion is undecided")
      ->check(tools::number_from(1, 1e9))
      ->capture_default_str()
      ->type_name("N");
  tools::add_common_options(app, o.common);
  app.footer(
      "Free is certain. Contacts are colliding where inner sets meet, which is certain, else "
      "within epsilon: the solids are at most that far apart "
      "(docs/algorithms/bounded-predicates.md). Waypoints and configurations are counted from 1.\n"
      "Exit codes: 0 free, and inside; 1 not free, or not certainly inside; 2 usage; 3 bad input; "
      "4 output failed; 6 internal error; "
      "7 undecided (--max-intervals; whether something is inside).");
}

std::size_t robot_named(const world::World& world, const std::string& name) {
  std::vector<std::string> names;
  for (const world::RobotModel& robot : world.robots) names.push_back(robot.name);
  if (name.empty()) {
    if (names.size() == 1) return 0;
    throw Error(ErrorCode::InvalidArgument, names.empty()
                                                ? "the scene has no robot"
                                                : "the scene has several robots: give --robot");
  }
  if (const auto robot = world.find_robot(name)) return *robot;
  throw Error(ErrorCode::InvalidArgument,
              "--robot: the scene has no robot '" + name + "'" + did_you_mean(name, names));
}

/// "0,1.5,-2": a value per variable.
robot::Path parse_configuration(const Options& o, const robot::Robot& robot) {
  const robot::NamedPath named = robot::parse_path_csv(o.configuration, "--configuration");
  const std::size_t given = named.waypoints.front().size() + o.joints.size(),
                    needed = robot.variables.size();
  if (named.joints.empty() && (named.waypoints.size() > 1 || given != needed)) {
    std::string names;
    for (const robot::Variable& v : robot.variables) names += (names.empty() ? "" : ",") + v.name;
    throw Error(ErrorCode::InvalidArgument,
                "--configuration: " + std::to_string(needed) +
                    " values are expected, one for each of " + names +
                    (given == needed ? ", on one line" : ", not " + std::to_string(given)));
  }
  robot::Path path =
      robot::arrange(named, robot, "--configuration", false, tools::fixed_joints(o.joints));
  if (o.degrees) path = robot::from_degrees(std::move(path), robot);
  if (!o.ignore_limits) robot::require_within_limits(path, robot, "--configuration");
  return path;
}

/// The result: with --quiet, exit code and report have it.
void say(const Options& o, const std::string& line) {
  if (!o.common.quiet) std::cout << line << '\n';
}

/// A robot is inside with all that it has and carries: what has shapes but no set cannot be told.
void require_whole(const world::RobotModel& robot) {
  for (std::uint32_t l = 0; l < robot.kinematics.links.size(); ++l) {
    const robot::Link& link = robot.kinematics.links[l];
    if (link.collision.empty() && link.visual.empty()) continue;
    if (std::none_of(robot.shapes.begin(), robot.shapes.end(),
                     [&](const world::LinkShape& shape) { return shape.link == l; }))
      throw Error(ErrorCode::InvalidInput,
                  "--inside: of robot '" + robot.name + "' link '" + link.name +
                      "' has shapes but no set, so it is not known whether it is inside: name "
                      "the links that are to be inside one by one");
  }
}

std::vector<world::Item> items_named(const world::World& world, const std::string& name) {
  if (const auto object = world.find_object(name)) return {{world::Item::kObject, *object}};
  std::vector<world::Item> out;
  std::vector<std::string> names;
  for (const world::Object& object : world.objects) names.push_back(object.name);
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    names.push_back(world.robots[r].name);
    if (name == world.robots[r].name) {
      require_whole(world.robots[r]);
      for (std::size_t i = 0; i < world.objects.size(); ++i)
        if (world.attachments[i] && world.attachments[i]->robot == r)
          out.push_back({world::Item::kObject, i});
    }
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
      names.push_back(world.name_of({r, s}));
      if (name == world.robots[r].name || name == names.back()) out.push_back({r, s});
    }
  }
  if (!out.empty()) return out;
  throw Error(ErrorCode::InvalidArgument, "--inside: the scene has no object, link or robot '" +
                                              name + "'" + did_you_mean(name, names));
}

/// What is to lie in which region.
struct Inside {
  std::string name, region_name;
  std::vector<world::Item> items;
  std::size_t region = 0;
};

std::vector<Inside> inside_of(const world::World& world, const std::vector<std::string>& texts) {
  std::vector<Inside> out;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw Error(ErrorCode::InvalidArgument,
                  "--inside: NAME=REGION is expected, not '" + text + "'");
    Inside one{text.substr(0, equals), text.substr(equals + 1), {}, 0};
    one.items = items_named(world, one.name);
    std::vector<std::string> names;
    for (const world::Region& region : world.regions) names.push_back(region.name);
    const auto found = std::find(names.begin(), names.end(), one.region_name);
    if (found == names.end())
      throw Error(ErrorCode::InvalidArgument, "--inside: the scene has no region '" +
                                                  one.region_name + "'" +
                                                  did_you_mean(one.region_name, names));
    one.region = static_cast<std::size_t>(found - names.begin());
    out.push_back(std::move(one));
  }
  return out;
}

/// Whether all that is asked for is inside; says and reports it.
collide::Inclusion decide_inside(const Options& o, const world::Checker& checker,
                                 const world::WorldState& state, const std::vector<Inside>& wanted,
                                 const std::string& before, tools::Json& report) {
  using collide::Inclusion;
  Inclusion all = Inclusion::Included;
  for (const Inside& one : wanted) {
    Inclusion whole = Inclusion::Included;
    for (const world::Item& item : one.items) {
      const Inclusion found = find_inclusion(checker, state, item, one.region);
      if (whole != Inclusion::NotIncluded && found != Inclusion::Included) whole = found;
    }
    const std::string answer = whole == Inclusion::Included      ? "inside"
                               : whole == Inclusion::NotIncluded ? "not certainly inside"
                                                                 : "undecided";
    std::string line = before + one.name;
    say(o, line.append(" in ").append(one.region_name).append(": ").append(answer));
    report["inside"].push_back(
        {{"what", one.name}, {"region", one.region_name}, {"answer", answer}});
    if (all != Inclusion::NotIncluded && whole != Inclusion::Included) all = whole;
  }
  return all;
}

int check_path(const Options& o, const tools::SceneFile& scene, std::size_t robot,
               const robot::Path& path, tools::Json& report) {
  const world::Checker checker(scene.world);
  world::MotionOptions options;
  options.resolution = tools::parse_length(o.resolution)->value;
  options.most_intervals = o.most_intervals;
  const world::MotionAnswer answer =
      check_motion(checker, initial_state(scene.world), robot, path, options);
  report["waypoints"] = path.size();
  report["resolution"] = options.resolution;
  report["motion"] = tools::to_json(scene.world, answer);
  say(o, tools::describe(scene.world, answer));
  if (!o.preview.empty()) {
    world::WorldState state = initial_state(scene.world);
    std::vector<world::Contact> contacts;
    state.q[robot] = path.back();
    if (answer.contact) {
      contacts.push_back(*answer.contact);
      const std::vector<double>&from = path[answer.contact_segment],
            &to = path[std::min(answer.contact_segment + 1, path.size() - 1)];
      for (std::size_t i = 0; i < from.size(); ++i)
        state.q[robot][i] = from[i] + answer.contact_share * (to[i] - from[i]);
    }
    io::write_file(o.preview, tools::picture_of(checker, state, contacts));
  }
  using Outcome = world::MotionAnswer::Outcome;
  report["answer"] = answer.outcome == Outcome::Free                             ? "free"
                     : answer.outcome == Outcome::Undecided                      ? "undecided"
                     : answer.contact && answer.contact->certain && answer.meets ? "colliding"
                                                                                 : "within epsilon";
  return answer.outcome == Outcome::Free        ? tools::kDone
         : answer.outcome == Outcome::Undecided ? tools::kLimit
                                                : tools::kNo;
}

int check_states(const Options& o, const tools::SceneFile& scene, std::optional<std::size_t> robot,
                 const robot::Path& values, tools::Json& report) {
  const world::Checker checker(scene.world);
  const world::Checker::Options options{.resting = o.resting};
  world::Scratch scratch;
  bool free = true, certain = false, drawn = false;
  const std::vector<Inside> wanted = inside_of(scene.world, o.inside);
  using collide::Inclusion;
  Inclusion inside = Inclusion::Included;
  tools::Json states = tools::Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    world::WorldState state = initial_state(scene.world);
    if (robot) state.q[*robot] = values[i];
    const std::vector<world::Contact> contacts = checker.find_contacts(state, scratch, options);
    tools::Json one = {{"free", contacts.empty()}, {"contacts", tools::Json::array()}};
    const std::string before =
        values.size() > 1 ? "configuration " + std::to_string(i + 1) + ": " : "";
    if (contacts.empty()) say(o, before + "free");
    for (const world::Contact& contact : contacts) {
      free = false;
      certain = certain || contact.certain;
      one["contacts"].push_back(tools::to_json(scene.world, contact));
      say(o, before + tools::describe(scene.world, contact));
    }
    const Inclusion here = decide_inside(o, checker, state, wanted, before, one);
    if (inside != Inclusion::NotIncluded && here != Inclusion::Included) inside = here;
    if (!o.preview.empty() && !drawn && (!contacts.empty() || i + 1 == values.size())) {
      io::write_file(o.preview, tools::picture_of(checker, state, contacts));
      drawn = true;
    }
    if (o.distance) {
      if (const auto nearest = checker.find_nearest(state, scratch, options)) {
        const auto& [items, clearance] = *nearest;
        one["distance"] = {
            {"lower", clearance.lower},
            {"upper", clearance.upper},
            {"pair", {scene.world.name_of(items[0]), scene.world.name_of(items[1])}}};
        std::ostringstream line;
        line << before << "nearest: " << scene.world.name_of(items[0]) << " and "
             << scene.world.name_of(items[1]) << ", sets " << clearance.lower << " to "
             << clearance.upper << " apart";
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

int check(const Options& o) {
  if (!o.path.empty() && (o.resting || o.distance || !o.inside.empty()))
    throw Error(ErrorCode::InvalidArgument,
                "--resting, --distance and --inside are for configurations");
  const tools::SceneFile scene = tools::read_scene(o.scene);
  std::vector<std::string> inputs = scene.inputs;
  inputs.insert(inputs.end(), {o.path, o.configurations});
  tools::require_apart({{"--report", o.common.report}, {"--preview", o.preview}}, inputs);
  std::vector<std::string> notes = scene.notes;
  tools::Json report = {{"scene", {{"file", o.scene}, {"sha256", scene.sha256}}}};
  std::optional<std::size_t> robot;
  const bool moves = !o.path.empty() || !o.configuration.empty() || !o.configurations.empty();
  if (moves || !o.robot.empty()) robot = robot_named(scene.world, o.robot);
  robot::Path values;
  if (robot) {
    const world::RobotModel& model = scene.world.robots[*robot];
    report["robot"] = model.name;
    const std::string file = o.path.empty() ? o.configurations : o.path;
    if (!file.empty())
      values =
          robot::read_path(file, model.kinematics,
                           {!o.ignore_limits, o.degrees, tools::fixed_joints(o.joints)}, notes);
    else if (!o.configuration.empty())
      values = parse_configuration(o, model.kinematics);
    else
      values = {model.home};
  } else {
    values = {{}};
  }
  for (const std::string& note : notes) tools::log(o.common.quiet, note);
  const int code = o.path.empty() ? check_states(o, scene, robot, values, report)
                                  : check_path(o, scene, *robot, values, report);
  if (!notes.empty()) report["notes"] = notes;
  tools::write_report(o.common, "kaboum-check", report);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Decides whether robots are free of collisions, at configurations or all along "
      "motions.",
      "kaboum-check"};
  Options options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] {
    // As from a variable of the shell that is not set: what was meant is not known.
    for (const char* name :
         {"--path", "--configuration", "--configurations", "--robot", "--preview"})
      if (app.count(name) > 0 && app.get_option(name)->as<std::string>().empty())
        throw Error(ErrorCode::InvalidArgument, std::string(name) + ": the value is empty");
    return check(options);
  });
}
