// The command line of kaboum-scene.

#include "options.h"

#include <CLI/CLI.hpp>

namespace kaboum::tools {

namespace {

void add_sources_of_sets(CLI::App& command, SceneOptions& o) {
  command
      .add_option("--package-path", o.packages,
                  "A package of package:// or a folder that holds it; may be repeated")
      ->type_name("DIR");
  command
      .add_option("--from-cache", o.cache,
                  "Cache of decompositions, used and filled [as bcd-decompose]")
      ->type_name("DIR");
  command.add_flag("--no-cache", o.no_cache, "Decompose anew and store nothing");
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
  make->add_option("--primitive", o.primitives,
                   "An object that is a box, sphere, cylinder, capsule or plane, in its middle and "
                   "along z: box:X,Y,Z, sphere:R, cylinder:R,LENGTH, capsule:R,LENGTH (without "
                   "caps) or plane:X,Y,Z (so wide, and so thick below); may be repeated")
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
  make->add_flag("--inner", o.inner, "Inner sets of objects as well: contacts can be certain");
  make->add_flag("--inner-links", o.inner_links,
                 "Inner sets of robots' links as well: so can contacts with them");
  make->add_flag("--visual", o.visual,
                 "Of robots, the shapes for drawing instead of those for collisions");
  make->add_option("--epsilon", o.epsilon,
                   "Largest distance of the sets from their meshes, a length or a percentage of "
                   "each mesh's diagonal")
      ->check([](const std::string& s) {
        return parse_length(s) ? std::string() : "must be a positive number or percentage";
      })
      ->capture_default_str()
      ->type_name("LENGTH|P%");
  make->add_option("--effort", o.effort, "Of the decomposition [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  make->add_flag("--drop-sheets", o.drop_sheets,
                 "Drop back-to-back faces without volume (they are then not covered)");
  make->add_option("--unit", o.unit,
                   "Unit of length of all meshes: m, dm, cm, mm, um, km, in or ft; with robots m")
      ->check(unit_name())
      ->capture_default_str()
      ->type_name("NAME");
  add_sources_of_sets(*make, o);
  make->add_flag("--force", o.force, "Replace a scene that exists, with all that was edited in it");
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
  pairs
      ->add_option("--max-boxes", o.most_boxes,
                   "Most boxes of joint values that are looked at for one pair")
      ->check(number_from(1, 1e9))
      ->capture_default_str()
      ->type_name("N");
  pairs->add_option("--timeout", o.timeout, "After so long, what is left stays unproved [none]")
      ->check(CLI::Range(0.001, 1e9).description(""))
      ->type_name("SECONDS");
  add_common_options(*pairs, o.common);
  return pairs;
}

}  // namespace kaboum::tools
