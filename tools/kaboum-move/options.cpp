// The options of kaboum-move.

#include "options.h"

#include <kaboum/motion/path_options.h>
#include <kaboum/world/margins.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"

namespace kaboum::tools {
namespace {

void describe_execution(CLI::App& app, MoveOptions& o) {
  auto* trajectory =
      app.add_option("--trajectory", o.trajectory,
                     "Write samples over time: from rest to rest along each segment, by quintic "
                     "polynomials, within the limits below; CSV, or a JointTrajectory of ROS 2 "
                     "where the name ends with .yaml, .yml or .json")
          ->type_name("FILE");
  add_request_options(app, motion::trajectory_options(), o.execution, o.stated);
  for (const auto& option : motion::trajectory_options())
    app.get_option("--" + option.name)->needs(trajectory);
}

}  // namespace

void describe(CLI::App& app, MoveOptions& o) {
  app.add_option("SCENE", o.scene, "Scene file (docs/scene.md)")->required();
  app.add_option("--robot", o.robot, "Which robot moves [the only one]")->type_name("NAME");
  auto* from =
      app.add_option("--from", o.from, "Joint values to start from, separated by commas [home]")
          ->type_name("Q1,Q2,…");
  app.add_option("--start", o.start, "Start from the last waypoint of a path, CSV or JSON")
      ->type_name("FILE")
      ->excludes(from);
  app.add_option("--to", o.to, "Joint values to go to; may be repeated: one of them is reached")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("Q1,Q2,…");
  app.add_option("--goals", o.goals, "Go to one of the lines of a file of joint values")
      ->type_name("FILE");
  app.add_option("--to-pose", o.to_pose,
                 "Pose of the tool in the world to go to: X,Y,Z or X,Y,Z,ROLL,PITCH,YAW or "
                 "X,Y,Z,QX,QY,QZ,QW or X,Y,Z and a matrix, row by row; may be repeated. One of all "
                 "configurations that reach it within the limits is gone to")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("POSE");
  app.add_option(
         "--reach", o.reach,
         "Constraints of the scene to meet at the end, by their name: one of 16 configurations "
         "that do, drawn at random, is gone to. May be repeated: one of them is met")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME");
  app.add_option("-o,--output", o.output, "The path's waypoints, CSV; - is stdout")
      ->check(csv_name())
      ->capture_default_str()
      ->type_name("FILE");
  app.add_flag("--degrees", o.degrees,
               "Angles are in degrees, those read and those in -o and --trajectory [radians]");
  app.add_option("--roadmap", o.roadmap,
                 "Find the path by a roadmap of the scene and the robot, JSON: it is read where "
                 "the file is there, and made and written where it is not. One of another scene is "
                 "refused")
      ->type_name("FILE");
  add_request_options(app, motion::path_options(), o.search, o.stated);
  add_request_options(app, motion::keep_options(), o.keep, o.stated);
  add_request_options(app, world::margin_options(), o.margin, o.stated);
  describe_execution(app, o);
  add_common_options(app, o.common);
  app.footer(
      "Objects, other robots and what is carried are as the scene has them. Paths are in radians "
      "(--degrees: degrees) and metres. A path that is written is certified; that none was found "
      "says nothing "
      "(docs/algorithms/motion-planning.md).\n"
      "Exit codes: 0 done; 1 the start, or every goal, is not free, breaks a constraint or is out "
      "of reach; 2 usage; 3 bad input; 4 output failed; 6 internal error; 7 no path found "
      "(--max-work, --max-nodes, --timeout), or there may be other goals than those that were "
      "found for a pose or constraints.");
}

}  // namespace kaboum::tools
