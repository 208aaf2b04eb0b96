// The options of sweep-approx, and what they ask for.

#include "options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <sstream>

#include "common/motion_options.h"
#include "common/set_format.h"

namespace kaboum::tools {
namespace {

const std::map<std::string, sweep::StepRule> kRules{
    {"baginski", sweep::StepRule::Baginski}, {"uniform", sweep::StepRule::Uniform},
    {"subset", sweep::StepRule::Subset},     {"second-order", sweep::StepRule::SecondOrder},
    {"adaptive", sweep::StepRule::Adaptive}, {"balanced", sweep::StepRule::Balanced}};

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

std::string check_length(const std::string& text) {
  const auto length = parse_length(text);
  return length && !length->percent
             ? std::string()
             : "must be a positive length without a unit, as in 0.005, not " + text +
                   (length ? " (there is no diagonal that it could be a percentage of before the "
                             "volume is made)"
                           : "");
}

void add_files(CLI::App& app, SweepApproxOptions& o) {
  auto* robot =
      app.add_option("ROBOT", o.robot, "Robot: URDF, or the Robotics Library's rlkin or rlmdl XML")
          ->type_name("FILE");
  auto* scene = app.add_option("--scene", o.scene,
                               "Instead of ROBOT, a robot of a scene where it stands there, with "
                               "the limits that the scene states (docs/scene.md)")
                    ->excludes(robot)
                    ->type_name("FILE");
  app.add_option("--robot", o.robot_name, "Which robot of the scene [the only one]")
      ->needs(scene)
      ->type_name("NAME");
  add_base_option(app, o.base_pose)->excludes(scene);
  app.add_option(
         "--path", o.path,
         "Waypoints in joint space, joined linearly: .csv, one line each, the joints named "
         "in the first line or in the robot's order; or .json. Radians (--degrees: degrees) and "
         "metres")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "-o,--output", o.output,
         "Where the bodies go: a .glb container, an .obj with one object per body, a folder "
         "with one STL per body, or a .urdf with them as shapes of one link, and "
         "a folder beside it (- for stdout)")
      ->required()
      ->type_name("PATH");
  app.add_option(
         "--epsilon", o.epsilon,
         "Largest margin round the bodies, by which they are enlarged. How far they then reach "
         "beyond what is swept is said at the end, and limited by --max-reach [0.005]")
      ->check(check_length)
      ->type_name("LENGTH");
}

void add_steps(CLI::App& app, SweepApproxOptions& o) {
  app.add_option("--bound", o.bound,
                 "How steps are chosen: baginski (not proved), uniform (the thesis's), subset, "
                 "second-order, adaptive (ends are poses), balanced (fewest) [balanced]")
      ->check(
          CLI::IsMember({"baginski", "uniform", "subset", "second-order", "adaptive", "balanced"})
              .description(""))
      ->type_name("NAME");
  app.add_option("--max-reach", o.reach,
                 "Largest distance of a hull, its margin apart, from what it bounds; takes more "
                 "bodies [no limit]")
      ->check(check_length)
      ->type_name("LENGTH");
  app.add_option(
         "--simplify", o.simplify,
         "Share of epsilon, 0 to 0.9, by which vertices may be left out: fewer of them, more "
         "bodies")
      ->check(number_from(0, 0.9))
      ->capture_default_str()
      ->type_name("SHARE");
  app.add_flag("--implicit-margin", o.implicit_margin,
               "Do not enlarge the bodies of a .glb by the margin, but state it in the file: fewer "
               "vertices, but whatever reads them has to add it");
}

void add_motion(CLI::App& app, SweepApproxOptions& o) {
  app.add_flag("--no-merge", o.no_merge, "One body at least between two waypoints");
  app.add_flag("--ignore-limits", o.ignore_limits, "Allow waypoints outside the joints' limits");
  add_joint_option(app, o.joints);
  add_degrees_option(app, o.degrees);
  app.add_option("--links", o.links, "Only these links, separated by commas [all]")
      ->type_name("A,B");
  app.add_option("--geometry", o.geometry, "Which shapes of a URDF [collision]")
      ->check(CLI::IsMember({"collision", "visual"}).description(""))
      ->type_name("collision|visual");
  app.add_flag_callback(
      "--visual", [&o] { o.geometry = "visual"; }, "The same as --geometry visual");
  app.add_option("--package-path", o.packages,
                 "A package of package:// or a folder that holds it, besides $ROS_PACKAGE_PATH, "
                 "$AMENT_PREFIX_PATH and the folders above ROBOT; may be repeated")
      ->type_name("DIR");
}

void add_bodies(CLI::App& app, SweepApproxOptions& o) {
  app.add_option("--body-epsilon", o.body_epsilon,
                 "Largest distance of the links' convex bodies from their meshes, a length or a "
                 "percentage of each mesh's diagonal [as --epsilon]")
      ->check([](const std::string& s) {
        return parse_length(s) ? std::string() : "must be a positive number or percentage";
      })
      ->type_name("LENGTH|P%");
  app.add_flag("--drop-sheets", o.drop_sheets,
               "Drop back-to-back faces without volume (they are then not covered)");
  app.add_option("--max-vertices-per-body", o.max_vertices,
                 "Most vertices of a link's body (8 to 100000)")
      ->check(CLI::Range(8, 100000).description(""))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--effort", o.body_effort, "Of the decomposition [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  app.add_option("--from-cache", o.cache,
                 "Cache of decompositions, used and filled [as bcd-decompose]")
      ->type_name("DIR");
  app.add_flag("--no-cache", o.no_cache, "Decompose anew and store nothing");
}

void add_output(CLI::App& app, SweepApproxOptions& o) {
  app.add_option("--unit", o.unit,
                 "Unit of length, noted in the container: m, dm, cm, mm, um, km, in or ft")
      ->check(unit_name())
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--mesh-prefix", o.prefix,
                 "Put before the bodies' file names in a .urdf, as in package://cell, with a slash "
                 "between; RViz and MoveIt need it [names relative to the URDF]")
      ->type_name("URI");
  app.add_option(
         "--preview", o.preview,
         "Write a picture of the swept volume (.png), or a page that shows it over the robot "
         "along the path in a browser (.html)")
      ->check(preview_name())
      ->type_name("FILE");
  app.add_option(
         "--depfile", o.depfile,
         "Write a Makefile dependency rule; names that have no place in one are refused. If "
         "FILE ends in .list: the inputs, each followed by a zero byte")
      ->type_name("FILE");
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');)
    if (!item.empty()) out.push_back(item);
  return out;
}

std::string parameters(const SweepApproxOptions& o, const std::string& base) {
  std::ostringstream out;
  out << "--epsilon " << o.epsilon << " --bound " << o.bound << " --body-epsilon "
      << (o.body_epsilon.empty() ? o.epsilon : o.body_epsilon) << " --max-vertices-per-body "
      << o.max_vertices << " --effort " << o.body_effort << " --geometry " << o.geometry;
  if (!o.reach.empty()) out << " --max-reach " << o.reach;
  if (o.simplify > 0) out << " --simplify " << o.simplify;
  if (!o.links.empty()) out << " --links " << o.links;
  for (const std::string& joint : o.joints) out << " --joint " << joint;
  if (o.degrees) out << " --degrees";
  if (!base.empty()) out << " --base-pose " << base;
  if (o.drop_sheets) out << " --drop-sheets";
  if (o.implicit_margin) out << " --implicit-margin";
  if (o.no_merge) out << " --no-merge";
  return out.str();
}

}  // namespace

bool SweepApproxOptions::urdf() const {
  return output_format.empty() && std::filesystem::path(output).extension() == ".urdf";
}

void describe(CLI::App& app, SweepApproxOptions& o) {
  add_files(app, o);
  add_steps(app, o);
  add_motion(app, o);
  add_bodies(app, o);
  add_output(app, o);
  add_set_format_option(app, o.output_format);
  add_common_options(app, o.common);
  app.footer(
      "The bodies contain the links' convex bodies, and these their meshes, at every "
      "configuration "
      "of the path (docs/algorithms/swept-volumes.md).\n"
      "Exit codes: 0 done; 1 a link is not held as asked for (what is held is swept), or float32 "
      "is too coarse for epsilon (nothing is written); 2 usage; "
      "3 bad input; 4 output failed; 5 not built; 6 internal error; 7 limit.");
}

certify::RobotRequest bodies_request(const SweepApproxOptions& o) {
  certify::RobotRequest r;
  r.shapes = {split(o.links), o.geometry == "visual", o.packages};
  r.set.epsilon = parse_length(o.body_epsilon.empty() ? o.epsilon : o.body_epsilon);
  r.set.max_vertices = o.max_vertices;
  r.set.effort = kEfforts.at(o.body_effort);
  r.set.preparation.drop_sheets = o.drop_sheets;
  r.set.wrap.emplace().where_needed = true;
  r.partial = true;
  return r;
}

certify::SweepRequest sweep_request(const SweepApproxOptions& o, const std::string& base) {
  certify::SweepRequest r;
  r.search.epsilon = parse_length(o.epsilon)->value;
  r.search.rule = kRules.at(o.bound);
  r.search.merge = !o.no_merge;
  r.search.simplify = o.simplify;
  r.search.explicit_margin = !o.implicit_margin;
  if (!o.reach.empty()) r.search.max_excess = parse_length(o.reach)->value;
  r.decide_motion = false;  // bound-verify sweep does, from the files alone
  r.parameters = parameters(o, base);
  r.unit = o.unit;
  return r;
}

io::SetFormat output_format(const SweepApproxOptions& o) {
  const io::SetFormat format =
      o.urdf() ? io::SetFormat::Directory : set_format_for(o.output, o.output_format);
  if (o.implicit_margin && format != io::SetFormat::Glb)
    throw Error(ErrorCode::InvalidArgument,
                "--implicit-margin: only .glb can state a margin; " + o.output + " cannot");
  if (!o.prefix.empty() && !o.urdf())
    throw Error(ErrorCode::InvalidArgument, "--mesh-prefix is for an output that is a .urdf");
  if (format == io::SetFormat::Directory)
    io::require_replaceable(o.urdf() ? std::filesystem::path(o.output).replace_extension()
                                     : std::filesystem::path(o.output));
  return format;
}

}  // namespace kaboum::tools
