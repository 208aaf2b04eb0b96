// The options of bcd-decompose that robots alone have.

#include "decompose_robot_options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>

namespace kaboum::tools {

void add_robot_options(CLI::App& app, DecomposeOptions& o) {
  app.add_option("--geometry", o.geometry, "Which shapes of a robot [collision]")
      ->check(CLI::IsMember({"collision", "visual"}).description(""))
      ->type_name("collision|visual");
  app.add_flag_callback(
      "--visual", [&o] { o.geometry = "visual"; }, "The same as --geometry visual");
  app.add_option("--links", o.links,
                 "Only these links of a robot, separated by commas; the others stay as they are "
                 "[all]")
      ->delimiter(',')
      ->type_name("A,B");
  app.add_option("--package-path", o.packages,
                 "A package of a robot's package:// or a folder that holds it, besides "
                 "$ROS_PACKAGE_PATH, $AMENT_PREFIX_PATH and the folders above the robot's file "
                 "(repeatable)")
      ->type_name("DIR");
  app.add_option(
         "--mesh-prefix", o.prefix,
         "Put before the bodies' file names in a robot's new URDF, as in package://arm, with "
         "a slash between; RViz and MoveIt need it [names relative to the URDF]")
      ->type_name("URI");
}

void require_options_of_meshes(const CLI::App& app, const DecomposeOptions& o) {
  for (const char* option :
       {"--geometry", "--visual", "--links", "--package-path", "--mesh-prefix"})
    if (app.get_option(option)->count() != 0)
      throw Error(ErrorCode::InvalidArgument, std::string(option) + " is for robots (.urdf); " +
                                                  o.input + " is taken for a mesh");
}

}  // namespace kaboum::tools
