// The command line of kaboum-check.

#include "options.h"

#include <kaboum/base/parse_length.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/robot/path_options.h>
#include <kaboum/world/check_options.h>
#include <kaboum/world/margins.h>

#include <CLI/CLI.hpp>

#include "batch.h"
#include "common/request_options.h"

namespace kaboum::tools {
namespace {

void describe_clouds(CLI::App& app, CheckOptions& o) {
  app.add_option("--cloud", o.clouds,
                 "Points of a sensor as one more obstacle, called as the file without its ending: "
                 ".ply, .pcd, .npy, .xyz, .txt, .asc or .csv, in the scene's unit; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  add_request_option(app, world::cloud_radius_option(), std::nullopt,
                     [&o](const std::string& value) { o.cloud_radius = parse_length(value); });
  app.add_option("--cloud-pose", o.cloud_pose,
                 "Where the frame of the points is, as X,Y,Z or X,Y,Z,ROLL,PITCH,YAW or "
                 "X,Y,Z,QX,QY,QZ,QW [the scene's]")
      ->type_name("POSE");
  app.add_option("--cloud-allow", o.cloud_allow,
                 "Contacts of this link with points are none, as of a base on a table that the "
                 "sensor sees; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("ROBOT/LINK");
  app.add_flag("--cloud-drop-invalid", o.cloud_drop_invalid,
               "Leave out points with coordinates that are NaN or infinite, as sensors have them "
               "where they see nothing");
}

/// Options of motions from files. @return the one that names these
CLI::Option* describe_path(CLI::App& app, CheckOptions& o) {
  auto* path = app.add_option("--path", o.paths,
                              "Decide a whole motion, at every instant: waypoints, CSV, JSON, YAML "
                              "or .npy, also as MoveIt, VAMP and cuRobo have them. Repeated, with "
                              "the robots' names: of robots that move at once, from "
                              "waypoint to waypoint together")
                   ->expected(1)
                   ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
                   ->type_name("[ROBOT=]FILE");
  app.add_option(
         "--between", o.between,
         "Of a motion: what joints do between waypoints: go straight; or follow the polynomials "
         "that controllers make of the file's positions and velocities (cubic), or of these and "
         "accelerations (quintic)")
      ->check(CLI::IsMember({kStraight, kCubic, kQuintic}).description(""))
      ->capture_default_str()
      ->type_name(std::string(kStraight) + "|" + kCubic + "|" + kQuintic)
      ->needs(path);
  return path;
}

}  // namespace

void describe(CLI::App& app, CheckOptions& o) {
  app.add_option("SCENE", o.scene, "Scene file (docs/scene.md)")->required();
  app.add_option("--robot", o.robot, "Which robot moves [the only one]")->type_name("NAME");
  CLI::Option* path = describe_path(app, o);
  auto* one = app.add_option("--configuration", o.configuration,
                             "Decide the robot at these joint values, separated by commas [home]")
                  ->type_name("Q1,Q2,…")
                  ->excludes(path);
  auto* several = app.add_option("--configurations", o.configurations,
                                 "Decide each line of a file of joint values, CSV or JSON")
                      ->type_name("FILE")
                      ->excludes(path)
                      ->excludes(one);
  app.add_option("--batch", o.batch,
                 "Decide each of very many configurations, and say how many are free: an array of "
                 "NumPy (.npy, a row for each), CSV or JSON")
      ->type_name("FILE")
      ->excludes(path)
      ->excludes(one)
      ->excludes(several);
  app.add_option(
         "--motions", o.motions,
         "With --batch: decide straight motions in joint space, at every instant: from each "
         "row to the next one, or from the first to the second of every two rows")
      ->check(CLI::IsMember({kConsecutive, kPairs}).description(""))
      ->type_name(std::string(kConsecutive) + "|" + kPairs);
  app.add_option(
         "--verdicts", o.verdicts,
         "With --batch: write 1 for each configuration (motion) that is free, else 0; an array of "
         "uint8 where the name ends in .npy, else lines")
      ->type_name("FILE");
  describe_clouds(app, o);
  add_request_options(app, robot::path_options(), o.reading, o.stated);
  add_request_options(app, world::state_options(), o.state, o.stated);
  add_request_options(app, world::margin_options(), o.margin, o.stated);
  app.add_flag("--distance", o.distance, "Say how far apart the nearest pair is (not with --path)");
  app.add_option(
         "--inside", o.inside,
         "Decide as well whether an object, ROBOT/LINK or ROBOT lies in a region, with --path "
         "at every instant; may be repeated")
      ->type_name("NAME=REGION");
  app.add_option(
         "--preview", o.preview,
         "Write a picture (PNG): what is in contact is orange, the bodies that meet red; of "
         "a motion the instant of its contact, or its end; of several configurations the "
         "first that is not free")
      ->check(png_name())
      ->type_name("FILE");
  add_request_options(app, world::motion_options(), o.motion, o.stated);
  add_request_options(app, motion::keep_options(), o.keep, o.stated);
  add_request_options(app, engines::engine_options(), o.engine, o.stated);
  app.add_flag("--compare", o.compare,
               "With --engine: ask own predicates, too, and say which pairs the two differ about, "
               "and how long each takes (not with --path)");
  add_common_options(app, o.common);
  app.footer(
      "Free is certain. Contacts are colliding where inner sets meet, which is certain, else "
      "within epsilon: the solids are at most that far apart "
      "(docs/algorithms/bounded-predicates.md). Waypoints and configurations are counted from 1.\n"
      "Fingers that hold something are decided wherever they stop within what the grasp allows; "
      "for --engine, --distance, --inside and --keep where they are stated "
      "(docs/planning/grippers.md).\n"
      "What --engine fcl, bullet or ode says is never certified: exit code 0 is then its word "
      "alone, and of a motion that of its samples (docs/algorithms/collision-engines.md).\n"
      "Exit codes: 0 free, inside, and kept; 1 not free, not certainly inside, or not kept; 2 "
      "usage; "
      "3 bad input; 4 output failed; 5 the engine is not built; 6 internal error; "
      "7 undecided (--max-intervals; whether something is inside, or kept).");
}

}  // namespace kaboum::tools
