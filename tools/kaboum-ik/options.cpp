// The command line of kaboum-ik.

#include "options.h"

#include <kaboum/base/error.h>
#include <kaboum/kinematics/inverse_options.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"

namespace kaboum::tools {

void describe(CLI::App& app, IkOptions& o) {
  CLI::Option* file =
      app.add_option("ROBOT", o.robot,
                     "URDF, xacro, MJCF, SDF, or the Robotics Library's rlkin or rlmdl")
          ->type_name("FILE");
  CLI::Option* scene =
      app.add_option("--scene", o.scene,
                     "A robot of this scene instead: poses are in the world, limits the scene's")
          ->type_name("FILE")
          ->excludes(file);
  add_xacro_arguments(app, o.xacro_arguments);
  app.get_option("--xacro-args")->excludes(scene);
  app.add_option("--package-path", o.packages,
                 "A package that $(find NAME) of xacro and model:// of SDF name, or a folder that "
                 "holds it, besides those of the environment and the folders above the robot's "
                 "file (repeatable)")
      ->type_name("DIR")
      ->excludes(scene);
  app.add_option("--robot", o.robot_name, "Which robot of the scene [the only one]")
      ->type_name("NAME")
      ->needs(scene);
  CLI::Option* tool =
      app.add_option(
             "--tool", o.tool,
             "Tool of the scene's robot that is to have the pose [the only one, without --tip]")
          ->type_name("NAME")
          ->needs(scene);
  app.add_option("--base", o.base,
                 "Link that the pose is relative to [the root; of a scene the world]")
      ->type_name("LINK");
  app.add_option("--tip", o.tip, "Link that is to have the pose [the last, if there is only one]")
      ->type_name("LINK")
      ->excludes(tool);
  CLI::Option* pose =
      app.add_option("--pose", o.pose,
                     "Where the tip is to be, in the robot's unit of length and radians: X,Y,Z or "
                     "X,Y,Z,ROLL,PITCH,YAW or X,Y,Z,QX,QY,QZ,QW or X,Y,Z and a matrix, row by row")
          ->type_name("POSE");
  CLI::Option* pose_of =
      app.add_option("--pose-of", o.pose_of,
                     "The pose of this configuration instead: a value per joint, with commas "
                     "between")
          ->type_name("Q1,Q2,…");
  pose->excludes(pose_of);
  app.add_option("--reference", o.reference,
                 "Of whole turns, the nearest to this configuration is printed; of a family with "
                 "a free joint, the one that keeps its value comes first; numeric search begins at "
                 "it [0,0,…]")
      ->type_name("Q1,Q2,…");
  app.add_flag("--degrees", o.degrees, "Angles are in degrees, those read and printed [radians]");
  add_request_options(app, kinematics::inverse_options(), o.request, o.stated);
  app.add_flag("--json", o.json, "Print JSON instead of a line of joint values per solution");
  add_common_options(app, o.common);
  app.footer(
      "Exit codes: 0 done; 1 there is no solution, or none within the limits; 2 usage; 3 bad "
      "input; "
      "4 output failed; 6 internal error; 7 none found, which proves nothing: numerically, or "
      "where "
      "the pose is singular and it is not decided that no family has one within the limits.");
}

void require_valid(const IkOptions& o) {
  if (o.robot.empty() && o.scene.empty())
    throw Error(ErrorCode::InvalidArgument, "of which robot? Give its file, or --scene SCENE");
  if (o.pose.empty() && o.pose_of.empty())
    throw Error(ErrorCode::InvalidArgument,
                "where is the tip to be? Give --pose X,Y,Z,QX,QY,QZ,QW or --pose-of Q1,Q2,…");
}

}  // namespace kaboum::tools
