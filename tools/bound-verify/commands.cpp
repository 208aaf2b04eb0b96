// bound-verify mesh, cover, robot, sweep and progressive.
#include "commands.h"

#include <CLI/CLI.hpp>
#include <array>
#include <string_view>
#include <utility>

namespace kaboum::tools {
namespace {

constexpr const char* kClaims =
    "Solid claim: points about which one mesh winds at least once are so in the other.\n"
    "Surface claim: every triangle of the enclosed mesh lies in the solid of the enclosing one.\n"
    "Both are answered; --claims says which decide the exit code.";

/// What decides where a bound is given.
constexpr const char* kBetweenMeshes =
    "Also decide that no distance between the surfaces, both ways, exceeds this: a length, or a "
    "percentage of ORIGINAL's bounding-box diagonal (0.5%); of an inner set, that it leaves out no "
    "point deeper than this inside ORIGINAL";
constexpr const char* kFromUnion =
    "Also decide that no point of the union is farther than this from ORIGINAL's solid (its "
    "surface when it is open and --prepare is not given): a length, or a percentage of ORIGINAL's "
    "bounding-box diagonal (0.5%)";
constexpr const char* kOfEachMesh =
    "Also decide that no body is farther than this from the meshes it holds: a length in the "
    "robot's unit, or a percentage of each mesh's diagonal (0.5%)";

CLI::Option* add_file(CLI::App& app, const char* name, std::string& file, const char* what) {
  return app.add_option(name, file, what)->type_name("FILE");
}

CLI::App* add_command(CLI::App& app, const char* name, const std::string& what,
                      const std::string& more) {
  CLI::App* command = app.add_subcommand(name, what);
  command->footer(more + (more.empty() ? "" : "\n\n") + kVerifyExitCodes);
  return command;
}

void add_mesh_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, "mesh", std::string("Decides whether one mesh encloses the other.\n\n") + kClaims,
      "A set of convex bodies that is to lie inside ORIGINAL (bcd-decompose --direction inner) is "
      "judged with --inner, too; add --prepare, and --epsilon E with the epsilon that was asked "
      "for or is recorded. A set that is to cover ORIGINAL: bound-verify cover.");
  CLI::Option_group* relation = c->add_option_group("Relation", "One of");
  relation->add_flag("--outer", o.outer, "APPROXIMATION encloses ORIGINAL");
  relation->add_flag("--inner", o.inner, "APPROXIMATION is enclosed by ORIGINAL");
  relation->require_option(1);
  add_file(*c, "ORIGINAL", o.original, "The mesh that was approximated (- for standard input)")
      ->required();
  add_file(*c, "APPROXIMATION", o.approximation,
           "The result: a mesh (- for standard input); with --inner also a set of convex bodies")
      ->required();
  add_claims(*c, o, {"all", "solid", "surface"});
  add_epsilon(*c, o, kBetweenMeshes);
  add_preparation(*c, o, "ORIGINAL");
  add_set(*c, o);
  add_witness(*c, o);
  add_unit(*c, o);
  add_input_format(*c, o);
  add_approximation_format(*c, o, "APPROXIMATION");
  add_exact_points(*c, o);
  add_limits(*c, o);
  add_common_options(*c, o.common);
}

void add_cover_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, "cover",
      std::string("Decides whether the union of a set's convex bodies covers a mesh.\n\n") +
          kClaims,
      "A result of bcd-decompose: --prepare --epsilon E, E the epsilon that was asked for or is "
      "recorded, and --drop-sheets where it was given.");
  add_file(*c, "ORIGINAL", o.original, "The mesh that is to be covered (- for standard input)")
      ->required();
  add_file(*c, "SET", o.approximation, "The bodies: .glb, .obj, a folder of .stl")->required();
  add_claims(*c, o, {"all", "solid", "surface"});
  add_epsilon(*c, o, kFromUnion);
  add_preparation(*c, o, "ORIGINAL");
  add_witness(*c, o);
  add_unit(*c, o);
  add_input_format(*c, o);
  add_approximation_format(*c, o, "SET");
  add_exact_points(*c, o);
  add_limits(*c, o);
  add_common_options(*c, o.common);
  c->preparse_callback([&o](std::size_t) { o.cover = true; });
}

void add_robot_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, "robot",
      "Decides whether two robots move alike, and the collision shapes of each link of the second "
      "hold those of the first.",
      "A mesh is held by the meshes of the same pose and scale in the same link, so that no "
      "rounding of poses matters; boxes, cylinders and spheres must be there again.\n\n"
      "One line says of each link whether every triangle of it is inside, or which are not, and by "
      "how much.\n\n"
      "A result of bcd-decompose or bmesh-decimate: bound-verify robot INPUT.urdf DIR/INPUT.urdf "
      "--prepare, with --visual, --links, --drop-sheets and --package-path where these were given, "
      "and --prepare=wrap where that was; their --html-report has the command.");
  add_file(*c, "ORIGINAL", o.original, "A robot (URDF)")->required();
  add_file(*c, "RESULT", o.approximation, "The robot whose shapes hold those of the first (URDF)")
      ->required();
  add_claims(*c, o, {"all", "solid", "surface"});
  add_epsilon(*c, o, kOfEachMesh);
  add_preparation(*c, o, "each mesh of ORIGINAL");
  add_links(*c, o);
  add_exact_points(*c, o);
  add_limits(*c, o);
  add_geometry(*c, o, "ORIGINAL");
  add_common_options(*c, o.common);
  c->preparse_callback([&o](std::size_t) { o.robot = true; });
}

void add_sweep_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(
      app, "sweep", "Decides whether a set of convex bodies holds a robot during a motion.",
      "Every triangle of the links' meshes, every box, cylinder and sphere, at every "
      "configuration of PATH, lies in a body enlarged by the margin: during the whole motion, not "
      "only at samples (docs/algorithms/swept-volumes.md); so do the insides of closed meshes. It "
      "shares the parsers of ROBOT and PATH with sweep-approx, and with --prepare what prepares "
      "meshes; nothing else. Meshes that sweep-approx prepared (its notes say so) need --prepare, "
      "and --drop-sheets where it was given.");
  const auto file = [&](const char* name, std::size_t index, const char* text) {
    const auto set = [&o, index](const std::string& value) {
      o.sweep.resize(3);
      o.sweep[index] = value;
    };
    c->add_option_function<std::string>(name, set, text)->type_name("FILE")->required();
  };
  file("ROBOT", 0, "The robot (URDF, rlkin, rlmdl)");
  file("PATH", 1, "Its motion (.csv, .json)");
  file("SWEPT", 2, "The bodies: .glb, .obj, a folder of .stl, .urdf");
  add_claims(*c, o, {"all", "surface"});
  add_preparation(*c, o, "each mesh of ROBOT");
  add_witness(*c, o);
  add_approximation_format(*c, o, "SWEPT");
  add_links(*c, o);
  add_exact_points(*c, o);
  add_geometry(*c, o, "ROBOT");
  add_motion(*c, o);
  add_common_options(*c, o.common);
}

void add_progressive_command(CLI::App& app, VerifyOptions& o) {
  CLI::App* c = add_command(app, "progressive",
                            "Replays a progressive file of bmesh-decimate: all its steps and "
                            "levels, every step checked exactly.",
                            "");
  add_file(*c, "ORIGINAL", o.original, "The mesh that it was made from (- for standard input)")
      ->required();
  add_file(*c, "FILE", o.approximation, "The progressive file")->required();
  add_unit(*c, o);
  add_input_format(*c, o);
  add_common_options(*c, o.common);
  c->preparse_callback([&o](std::size_t) { o.progressive = true; });
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
