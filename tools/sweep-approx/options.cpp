// The options of sweep-approx, and what they ask for.

#include "options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "common/request_options.h"
#include "common/set_format.h"

namespace kaboum::tools {
namespace {

void add_files(CLI::App& app, SweepApproxOptions& o) {
  auto* robot =
      app.add_option("ROBOT", o.robot,
                     "Robot: URDF, xacro, MJCF, SDF, or the Robotics Library's rlkin or rlmdl XML")
          ->type_name("FILE");
  auto* scene = app.add_option("--scene", o.scene,
                               "Instead of ROBOT, a robot of a scene where it stands there, with "
                               "the limits that the scene states (docs/scene.md)")
                    ->excludes(robot)
                    ->type_name("FILE");
  add_xacro_arguments(app, o.xacro_arguments);
  app.get_option("--xacro-args")->excludes(scene);
  app.add_option("--robot", o.robot_name, "Which robot of the scene [the only one]")
      ->needs(scene)
      ->type_name("NAME");
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
}

/// Options that lead to a set but are no part of its request.
void add_set(CLI::App& app, SweepApproxOptions& o) {
  add_request_options(app, certify::swept_set_options(), o.sweep, o.stated);
  app.get_option("--base-pose")->excludes("--scene");
  app.add_flag_callback(
      "--visual", [&o] { o.sweep.visual = true; }, "The same as --geometry visual");
  app.add_option("--from-cache", o.cache,
                 "Cache of decompositions, used and filled [as bcd-decompose]")
      ->type_name("DIR");
  app.add_flag("--no-cache", o.no_cache, "Decompose anew and store nothing");
}

void add_output(CLI::App& app, SweepApproxOptions& o) {
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

}  // namespace

bool SweepApproxOptions::urdf() const {
  return output_format.empty() && std::filesystem::path(output).extension() == ".urdf";
}

void describe(CLI::App& app, SweepApproxOptions& o) {
  add_files(app, o);
  add_set(app, o);
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

io::SetFormat output_format(const SweepApproxOptions& o) {
  const io::SetFormat format =
      o.urdf() ? io::SetFormat::Directory : set_format_for(o.output, o.output_format);
  if (o.sweep.implicit_margin && format != io::SetFormat::Glb)
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
