// bound-verify mesh, cover, robot, sweep and progressive.
#include "commands.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/sphere_file.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/file_kind.h"
#include "common/request_options.h"
#include "robot_bodies.h"
#include "robot_spheres.h"

namespace kaboum::tools {
namespace {

constexpr const char* kClaims =
    "Solid claim: points about which one mesh winds at least once are so in the other.\n"
    "Surface claim: every triangle of the enclosed mesh lies in the solid of the enclosing one.\n"
    "Both are answered; --claims says which decide the exit code.";

/// Options of verdicts on robots that count where spheres are judged.
constexpr std::array<std::string_view, 4> kOfSpheres{"geometry", "links", "package-path",
                                                     "epsilon"};

/// A command.
/// @param decide  what it does
CLI::App* add_command(CLI::App& app, VerifyOptions& o, const char* name, const std::string& what,
                      const std::string& more, const std::function<int()>& decide) {
  CLI::App* command = app.add_subcommand(name, what);
  command->footer(more + (more.empty() ? "" : "\n\n") + kVerifyExitCodes);
  command->preparse_callback([&o, decide](std::size_t) { o.decide = decide; });
  return command;
}

void add_file(CLI::App& app, const char* name, std::string& file, const char* what) {
  app.add_option(name, file, what)->type_name("FILE")->required();
}

void add_witness(CLI::App& app, std::string& witness) {
  app.add_option("--witness", witness,
                 "When refuted, write the offending triangles to this mesh file")
      ->type_name("FILE");
}

void add_original_format(CLI::App& app, InputFormat& format) {
  add_input_format(app, format, "Format of ORIGINAL [by extension]");
}

/// @param of  the file
void add_approximation_format(CLI::App& app, std::string& format, const std::string& of) {
  app.add_option("--approximation-format", format, "Format of " + of + " [by extension]")
      ->type_name("NAME");
}

/// Short for the claim about the surface of the file as it is.
void add_raw(CLI::App& app, verify::Claims& claims) {
  app.add_flag_callback(
         "--raw", [&claims] { claims = verify::Claims::Surface; },
         "Judge the triangles of the file as they are, open, one-sided or in pieces: whether each "
         "of them lies in the result's solid; the same as --claims surface without --prepare")
      ->excludes("--prepare")
      ->excludes("--claims");
}

void add_visual(CLI::App& app, robot::ShapeChoice& shapes) {
  app.add_flag_callback(
      "--visual", [&shapes] { shapes.visual = true; }, "The same as --geometry visual");
}

/// What `mesh` and `cover` have alike.
/// @param result  name of the approximation
void add_mesh_options(CLI::App& app, VerifyOptions& o,
                      const std::vector<Option<verify::MeshVerdictOptions>>& options,
                      const char* result) {
  add_request_options(app, options, o.mesh.how, o.stated);
  add_raw(app, o.mesh.how.claims);
  add_witness(app, o.mesh.witness);
  add_unit_options(app, o.mesh.unit, "ORIGINAL");
  add_original_format(app, o.mesh.original_format);
  add_approximation_format(app, o.mesh.approximation_format, result);
  add_common_options(app, o.common);
}

int decide_meshes(VerifyOptions& o) {
  require_none(contradiction(o.mesh.how));
  return verify_mesh(o.mesh, o.common);
}

void add_mesh_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, o, "mesh", std::string("Decides whether one mesh encloses the other.\n\n") + kClaims,
      "A set of convex bodies that is to lie inside ORIGINAL (bcd-decompose --direction inner) is "
      "judged with --inner, too; add --prepare, and --epsilon E with the epsilon that was asked "
      "for or is recorded. A set that is to cover ORIGINAL: bound-verify cover.",
      [&o] { return decide_meshes(o); });
  CLI::Option_group* relation = c->add_option_group("Relation", "One of");
  const auto add_relation = [&](const char* flag, verify::Relation value, const char* text) {
    relation->add_flag_callback(
        flag, [&o, value] { o.mesh.relation = value; }, text);
  };
  add_relation("--outer", verify::Relation::Outer, "APPROXIMATION encloses ORIGINAL");
  add_relation("--inner", verify::Relation::Inner, "APPROXIMATION is enclosed by ORIGINAL");
  relation->require_option(1);
  add_file(*c, "ORIGINAL", o.mesh.original,
           "The mesh that was approximated (- for standard input)");
  add_file(*c, "APPROXIMATION", o.mesh.approximation,
           "The result: a mesh (- for standard input); with --inner also a set of convex bodies");
  c->add_flag("--set", o.mesh.set,
              "With --inner: APPROXIMATION is a set of convex bodies (known anyway of folders and "
              "of containers)");
  add_mesh_options(*c, o, verify::mesh_verdict_options(), "APPROXIMATION");
}

void add_cover_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, o, "cover",
      std::string("Decides whether the union of a set's convex bodies covers a mesh.\n\n") +
          kClaims,
      "A result of bcd-decompose: --prepare --epsilon E, E the epsilon that was asked for or is "
      "recorded, and --drop-sheets where it was given.",
      [&o] {
        o.mesh.relation = verify::Relation::Cover;
        return decide_meshes(o);
      });
  add_file(*c, "ORIGINAL", o.mesh.original,
           "The mesh that is to be covered (- for standard input)");
  add_file(*c, "SET", o.mesh.approximation, "The bodies: .glb, .obj, a folder of .stl");
  add_mesh_options(*c, o, verify::cover_verdict_options(), "SET");
  c->add_option("--epsilon-map", o.mesh.epsilon_map,
                "Also decide that no point of the union in a region is farther from the solid than "
                "the region's own epsilon (a JSON file, as for bcd-decompose)")
      ->type_name("FILE");
}

/// Refuses files of a kind that another option, or command, takes.
/// @throws Error{InvalidArgument}
void require_kinds(const VerifyRobotOptions& o) {
  const auto refuse = [](const std::string& file, const std::string& remedy) {
    throw Error(ErrorCode::InvalidArgument,
                "robot: " + file + " is " + in_words(kind_of(file)) + ": " + remedy);
  };
  const std::string of_mesh =
      "bound-verify cover ORIGINAL SET and bound-verify mesh decide of meshes";
  if (kind_of(o.original) == FileKind::Spheres)
    refuse(o.original, "the robot comes first: bound-verify robot ROBOT --spheres FILE");
  if (kind_of(o.original) == FileKind::Mesh) refuse(o.original, of_mesh);
  if (kind_of(o.result) == FileKind::Mesh && !is_folder(o.result)) refuse(o.result, of_mesh);
  if (kind_of(o.result) == FileKind::Mesh)
    refuse(o.result, "name the robot in it, as in " + o.result + "/robot.urdf");
  if (kind_of(o.spheres) == FileKind::Mesh)
    refuse(o.spheres,
           "--spheres takes those of a robot's links (.yaml, .yml, .xrdf, .srdf, or .urdf with "
           "spheres); " +
               of_mesh);
  if (kind_of(o.spheres) == FileKind::Robot && !o.spheres.ends_with(".urdf") &&
      !o.spheres.ends_with(".xacro"))
    refuse(o.spheres, "--bodies takes it (spheres, boxes and capsules of MJCF and SDF)");
  if (kind_of(o.bodies) == FileKind::Spheres) refuse(o.bodies, "--spheres takes it");
  if (kind_of(o.bodies) == FileKind::Mesh)
    refuse(o.bodies, "--bodies takes a robot (URDF, MJCF, SDF); " + of_mesh);
}

/// One of a result, spheres and bodies is judged.
int decide_robot(const CLI::App& app, VerifyOptions& o) {
  require_none(contradiction(o.robot.how));
  const auto given =
      std::ranges::count_if(std::array{&o.robot.result, &o.robot.spheres, &o.robot.bodies},
                            [](const std::string* file) { return !file->empty(); });
  if (given == 0)
    throw Error(ErrorCode::InvalidArgument,
                "robot: RESULT or --spheres FILE or --bodies FILE is needed");
  if (given > 1)
    throw Error(ErrorCode::InvalidArgument,
                "robot: RESULT, --spheres and --bodies are results to be judged: state one");
  require_kinds(o.robot);
  // Files of spheres are known by their names.
  if (robot::is_sphere_file(o.robot.result)) o.robot.spheres.swap(o.robot.result);
  if (o.robot.spheres.empty() && !o.robot.page.empty())
    throw Error(ErrorCode::InvalidArgument, "robot: --page shows spheres: state --spheres");
  if (!o.robot.result.empty()) return verify_robot(o.robot, o.common);
  std::vector<std::string> others{"--raw"};
  for (const auto& option : verify::robot_verdict_options())
    if (std::ranges::find(kOfSpheres, option.name) == kOfSpheres.end())
      others.push_back("--" + std::string(option.name));
  const bool spheres = !o.robot.spheres.empty();
  require_absent(*app.get_subcommand("robot"), spheres ? "--spheres" : "--bodies", others);
  return spheres ? verify_spheres(o.robot, o.common) : verify_bodies(o.robot, o.common);
}

void add_robot_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, o, "robot",
      "Decides whether two robots move alike, and the collision shapes of each link of the second "
      "hold those of the first.",
      "A mesh is held by the meshes of the same pose and scale in the same link, so that no "
      "rounding of poses matters; boxes, cylinders and spheres must be there again.\n\n"
      "One line says of each link whether every triangle of it is inside, or which are not, and by "
      "how much.\n\n"
      "A result of bcd-decompose or bmesh-decimate: bound-verify robot INPUT.urdf DIR/INPUT.urdf "
      "--prepare, with --visual, --links, --drop-sheets, --xacro-args and --package-path where "
      "these "
      "were given, "
      "and --prepare=wrap where that was; their --html-report has the command.",
      [&o, &app] { return decide_robot(app, o); });
  add_file(*c, "ORIGINAL", o.robot.original, "A robot (URDF)");
  c->add_option("RESULT", o.robot.result,
                "The robot whose shapes hold those of the first (URDF); or a file of spheres "
                "(.yaml, .yml, .xrdf, .srdf), as for --spheres")
      ->type_name("FILE");
  c->add_option(
       "--spheres", o.robot.spheres,
       "Instead of RESULT, spheres of the links, in their frames: cuRobo's YAML "
       "(collision_spheres), XRDF, an SRDF with link_sphere_approximation, or a URDF with "
       "spheres as collision shapes. Decides of each "
       "link whether its own spheres hold its triangles, as the files have them, and the "
       "solid that they bound; else says how much of its surface is outside, and how "
       "deep. With --epsilon, a length, also whether no point of a sphere is farther than that "
       "from "
       "its link's shapes (meshes prepared as bcd-decompose does, holes filled). Lengths are those "
       "of the robot's file: metres. Beside these only --epsilon-map, --geometry, --links, "
       "--package-path "
       "and --page may be stated")
      ->type_name("FILE");
  c->add_option("--page", o.robot.page,
                "With spheres: write a page (.html) that shows the robot with them in a browser, "
                "what sticks out in red, and a row for each link")
      ->check(page_name())
      ->type_name("FILE");
  c->add_option(
       "--bodies", o.robot.bodies,
       "Instead of RESULT, a robot (URDF, MJCF, SDF) whose collision shapes are spheres, "
       "boxes, capsules and "
       "cylinders with or without spheres at their ends: decides of each link whether its "
       "own shapes hold its triangles, as --spheres does of spheres, with --epsilon "
       "whether none is farther from the link's shapes, and whether both "
       "robots move alike (of a file in another format up to 1e-9 of the robot's size). "
       "Beside it only --epsilon, --epsilon-map, --geometry, --links and --package-path may be "
       "stated")
      ->type_name("FILE");
  c->add_option("--epsilon-map", o.robot.epsilon_map,
                "Also decide that no point of a body in a region is farther from what the body's "
                "link has than the region's own epsilon, and of links as a whole their own instead "
                "of --epsilon (a JSON file, as for bcd-decompose ROBOT)")
      ->type_name("FILE");
  add_xacro_arguments(*c, o.robot.xacro_arguments);
  add_request_options(*c, verify::robot_verdict_options(), o.robot.how, o.stated);
  add_raw(*c, o.robot.how.claims);
  add_visual(*c, o.robot.how.shapes);
  add_common_options(*c, o.common);
}

void add_sweep_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, o, "sweep", "Decides whether a set of convex bodies holds a robot during a motion.",
      "Every triangle of the links' meshes, every box, cylinder and sphere, at every "
      "configuration of PATH, lies in a body enlarged by the margin: during the whole motion, not "
      "only at samples (docs/algorithms/swept-volumes.md); so do the insides of closed meshes. It "
      "shares the parsers of ROBOT and PATH with sweep-approx, and with --prepare what prepares "
      "meshes; nothing else. Meshes that sweep-approx prepared (its notes say so) need --prepare, "
      "and --drop-sheets where it was given.",
      [&o] {
        require_none(contradiction(o.sweep.how));
        return verify_sweep(o.sweep, o.common);
      });
  add_file(*c, "ROBOT", o.sweep.robot, "The robot (URDF, rlkin, rlmdl)");
  add_file(*c, "PATH", o.sweep.path, "Its motion (.csv, .json)");
  add_file(*c, "SWEPT", o.sweep.swept, "The bodies: .glb, .obj, a folder of .stl, .urdf");
  add_request_options(*c, verify::motion_verdict_options(), o.sweep.how, o.stated);
  add_xacro_arguments(*c, o.sweep.xacro_arguments);
  add_raw(*c, o.sweep.how.claims);
  add_visual(*c, o.sweep.how.shapes.choice);
  add_witness(*c, o.sweep.witness);
  add_approximation_format(*c, o.sweep.set_format, "SWEPT");
  add_common_options(*c, o.common);
}

void add_progressive_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(app, o, "progressive",
                            "Replays a progressive file of bmesh-decimate: all its steps and "
                            "levels, every step checked exactly.",
                            "", [&o] { return verify_progressive(o.progressive, o.common); });
  add_file(*c, "ORIGINAL", o.progressive.original,
           "The mesh that it was made from (- for standard input)");
  add_file(*c, "FILE", o.progressive.progressive, "The progressive file");
  add_unit_options(*c, o.progressive.unit, "ORIGINAL");
  add_original_format(*c, o.progressive.original_format);
  add_common_options(*c, o.common);
}

}  // namespace

std::string command_instead(int argc, const char* const* argv) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kCommands{
      {{"--outer", "mesh --outer ORIGINAL RESULT"},
       {"--inner", "mesh --inner ORIGINAL RESULT"},
       {"--cover", "cover ORIGINAL SET"},
       {"--robot", "robot ORIGINAL RESULT"},
       {"--sweep", "sweep ROBOT PATH SWEPT"},
       {"--progressive", "progressive ORIGINAL FILE"}}};
  const auto starts = [](std::string_view command, std::string_view word) {
    return command.starts_with(word) && command.substr(word.size()).starts_with(' ');
  };
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--") break;
    for (const auto& [flag, command] : kCommands) {
      if (i == 1 && starts(command, word)) return {};
      if (word == flag)
        return "a command is to come first: instead of " + std::string(flag) + ", bound-verify " +
               std::string(command);
    }
  }
  return {};
}

void add_commands(CLI::App& app, VerifyOptions& options) {
  app.require_subcommand(1);
  add_mesh_command(app, options);
  add_cover_command(app, options);
  add_robot_command(app, options);
  add_sweep_command(app, options);
  add_progressive_command(app, options);
}

}  // namespace kaboum::tools
