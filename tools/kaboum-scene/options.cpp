// The command line of kaboum-scene.

#include "options.h"

#include <kaboum/scene/scene_options.h>
#include <kaboum/world/check_options.h>

#include <CLI/CLI.hpp>

#include "common/arguments.h"
#include "common/request_options.h"

namespace kaboum::tools {

namespace {

void add_sources_of_sets(CLI::App& command, SceneOptions& o) {
  command
      .add_option("--from-cache", o.cache,
                  "Cache of decompositions, used and filled [as bcd-decompose]")
      ->type_name("DIR");
  command.add_flag("--no-cache", o.no_cache, "Decompose anew and store nothing");
}

/// A subcommand that writes what it derives of objects into their scene.
CLI::App* describe_derived(CLI::App& app, SceneOptions& o, const char* name, const char* text,
                           const char* of_object) {
  CLI::App* command = app.add_subcommand(name, text);
  command->add_option("SCENE", o.scene, "Scene file; all else in it stays, but comments of YAML")
      ->required();
  command->add_option("--object", o.objects, of_object)->type_name("NAME");
  return command;
}

}  // namespace

CLI::App* describe_make(CLI::App& app, SceneOptions& o) {
  CLI::App* make = app.add_subcommand(
      "make", "Make a scene of URDFs and meshes, with the convex sets that it needs");
  make->add_option("SCENE", o.scene,
                   "Scene file to write (.json or .yaml); sets go into a folder beside it")
      ->required();
  make->add_option("--robot", o.robots, "A robot; may be repeated")->type_name("NAME=URDF");
  make->add_option("--object", o.objects, "An object; may be repeated")->type_name("NAME=MESH");
  make->add_option(
          "--primitive", o.primitives,
          "An object that is a box, sphere, cylinder, capsule or plane, in its middle and "
          "along z: box:X,Y,Z, sphere:R, cylinder:R,LENGTH, capsule:R,LENGTH (without "
          "caps) or plane:X,Y,Z (so wide, and so thick below), lengths in the scene's unit, or "
          "with one, as in 5mm; may be repeated")
      ->type_name("NAME=KIND:SIZES");
  make->add_option("--region", o.regions, "A region: its inner set; may be repeated")
      ->type_name("NAME=MESH");
  make->add_option("--at", o.places,
                   "Where the thing of this name stands in the world, in the scene's unit and "
                   "radians: X,Y,Z or X,Y,Z,ROLL,PITCH,YAW or X,Y,Z,QX,QY,QZ,QW; may be repeated "
                   "[the origin]")
      ->type_name("NAME=POSE");
  make->add_option("--scale", o.scales,
                   "Multiply the coordinates of this object's or region's mesh by FACTOR first, as "
                   "for one in mm of a scene in m: 0.001; may be repeated [1]")
      ->type_name("NAME=FACTOR");
  add_request_options(*make, scene::scene_options(), o.make, o.stated);
  make->add_flag_callback(
      "--visual", [&o] { o.make.options.visual = true; }, "The same as --geometry visual");
  add_sources_of_sets(*make, o);
  add_common_options(*make, o.common);
  return make;
}

CLI::App* describe_update(CLI::App& app, SceneOptions& o) {
  CLI::App* update = app.add_subcommand(
      "update", "Make those sets of a scene anew that are out of date, as they were made before");
  update
      ->add_option("SCENE", o.scene,
                   "Scene file; all but its sets (and of YAML, comments) stays as it is")
      ->required();
  add_request_options(*update, scene::update_options(), o.make, o.stated);
  add_sources_of_sets(*update, o);
  add_common_options(*update, o.common);
  return update;
}

CLI::App* describe_pairs(CLI::App& app, SceneOptions& o) {
  CLI::App* pairs = app.add_subcommand(
      "pairs", "Find pairs of a robot's links that never touch, with proof, or always do");
  pairs->add_option("SCENE", o.scene, "Scene file")->required();
  pairs->add_option("--robot", o.robot, "Which robot [the only one]")->type_name("NAME");
  pairs->add_option("--srdf", o.srdf, "Write the pairs as SRDF")->type_name("FILE");
  add_request_options(*pairs, world::pair_options(), o.pairs, o.stated);
  add_common_options(*pairs, o.common);
  return pairs;
}

CLI::App* describe_grasps(CLI::App& app, SceneOptions& o) {
  CLI::App* grasps = describe_derived(
      app, o, "grasps",
      "Derive grasps of objects from the faces and round sides of their sets, free of "
      "contact with the hand, and write them into the scene",
      "An object that gets grasps; may be repeated [all]");
  add_request_options(*grasps, scene::grasp_options(), o.derived_grasps, o.stated);
  grasps
      ->add_option("--preview", o.preview,
                   "Write a page (.html) that shows the grasps round their objects")
      ->type_name("FILE")
      ->check(page_name());
  add_common_options(*grasps, o.common);
  return grasps;
}

CLI::App* describe_places(CLI::App& app, SceneOptions& o) {
  CLI::App* places = describe_derived(
      app, o, "places",
      "Derive points on which objects stand (bottom), and on which others are put (top, top2, …), "
      "and "
      "the surfaces that look up (face, face2, …), from level faces of their sets, and write them "
      "into the scene",
      "An object that gets them; may be repeated [all]");
  add_request_options(*places, scene::place_options(), o.derived_places, o.stated);
  places
      ->add_option("--preview", o.preview,
                   "Write a page (.html) that shows the points and surfaces on their objects")
      ->type_name("FILE")
      ->check(page_name());
  add_common_options(*places, o.common);
  return places;
}

}  // namespace kaboum::tools
