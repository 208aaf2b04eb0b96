// The options of bcd-decompose by group, and what they ask for.

#include "options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"
#include "common/set_format.h"
#include "inertia.h"

namespace kaboum::tools {
namespace {

void add_input(CLI::App& app, DecomposeOptions& o) {
  app.add_option("INPUT", o.input,
                 "Mesh or STEP file to decompose (- for stdin), or a robot (.urdf, .xacro, .xml, "
                 ".sdf), every "
                 "link of it")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "-o,--output", o.output,
         "Where the bodies go: a .glb container, an .obj with one object per body, or a "
         "folder with one STL per body (- for stdout); for robots a folder, which gets a "
         "URDF, the bodies that it refers to, and a container per link; with --bodies spheres a "
         ".yaml (cuRobo), .xrdf, .srdf or .urdf file; with spheres, capsules, boxes or mixed "
         "bodies the robot with them as .urdf, .xml (MJCF) or .sdf")
      ->required()
      ->type_name("PATH");
}

void add_budget(CLI::App& app, const char* name, std::size_t& value, const char* what) {
  app.add_option(name, value,
                 std::string("Most ") + what +
                     " of all links of a robot together (1 to 10000000): the least epsilon that "
                     "allows, the same for all links, so that bodies go where they are needed; "
                     "takes about as long as ten runs")
      ->check(CLI::Range(1, 10000000).description(""))
      ->type_name("N");
}

void add_share(CLI::App& app, DecomposeOptions& o) {
  app.add_option_function<std::string>(
         "--share",
         [&o](const std::string& value) {
           o.share = value == "mean" ? certify::SphereShare::Mean : certify::SphereShare::Farthest;
         },
         "What --robot-bodies makes least over the links with --bodies spheres: the farthest point "
         "of any link, and with spheres that are left the mean; or the mean of the links' farthest "
         "points")
      ->check(CLI::IsMember({"farthest", "mean"}).description(""))
      ->default_str("farthest")
      ->needs("--robot-bodies")
      ->type_name("farthest|mean");
}

void add_repair(CLI::App& app, DecomposeOptions& o) {
  app.add_option(
         "--repair", o.repair,
         "Spheres of the robot's links, as bound-verify robot --spheres reads them: instead "
         "of new ones, these are changed as little as is found to suffice (grown, moved, "
         "others added; made smaller where they reach farther than --epsilon) until each "
         "link's hold its shapes, and written to --output in the format that they have")
      ->needs("--epsilon")
      ->type_name("FILE");
}

void add_pairs(CLI::App& app, DecomposeOptions& o) {
  app.add_option("--pairs", o.pairs,
                 "With --bodies spheres: a file of pairs of links that need no check, as "
                 "kaboum-pairs ROBOT --srdf writes one (SRDF; also MJCF, Drake's filter groups, "
                 "XRDF and cuRobo's YAML). Those of links with spheres are written as well, where "
                 "cuRobo, XRDF and SRDF have them; kaboum-pairs ROBOT --judge FILE decides whether "
                 "they never touch")
      ->type_name("FILE");
}

void add_output(CLI::App& app, DecomposeOptions& o) {
  app.add_option(
         "--preview", o.preview,
         "Write a picture of the bodies (.png), or a page that shows them over the input in "
         "a browser (.html); of a robot's spheres, capsules and boxes a scene for viewers (.glb), "
         "of spheres also a page that shows the robot with them (.html)")
      ->check(preview_or_scene_name())
      ->type_name("FILE");
  app.add_option("--explode", o.explode,
                 "How far apart a picture's second panel draws the bodies; 0: no second panel")
      ->check(number_from(0, 10))
      ->capture_default_str()
      ->needs("--preview")
      ->type_name("X");
  app.add_flag("--no-cache", o.no_cache,
               "Neither use nor store results of earlier runs ($KABOUM_CACHE, else "
               "$XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum)");
}

}  // namespace

void describe(CLI::App& app, DecomposeOptions& o) {
  add_input(app, o);
  add_request_options(app, certify::set_options(), o.set, o.stated);
  app.add_option_function<std::string>(
         "--epsilon-map",
         [&o](const std::string& file) {
           o.epsilon_map = file;
           o.stated.insert(certify::kRegionsOption);
         },
         "Regions (boxes, half-spaces and balls in the coordinates of the bodies, which are "
         "those of INPUT after --scale; a JSON file: docs/formats.md) with an epsilon each: no "
         "point of the bodies in one is farther than that from the solid, and elsewhere --epsilon "
         "counts. Of a robot each is fixed in the frame of a link, or is a link as a whole")
      ->type_name("FILE");
  add_require_closed(app, o.set.preparation);
  add_output(app, o);
  add_robot_options(app, o.robot, true);
  add_budget(app, "--robot-bodies", o.robot_bodies, "bodies");
  add_budget(app, "--robot-vertices", o.robot_vertices, "vertices");
  add_share(app, o);
  add_repair(app, o);
  add_pairs(app, o);
  app.add_flag(
      "--srdf", o.srdf,
      "Also write NAME.srdf beside a robot's URDF, which MoveIt reads: pairs of links that "
      "need no check, because they are connected or their bodies are proved never to "
      "touch, at whatever joint values within the limits (for one turn of joints without "
      "limits); not with --links");
  app.add_option("--inertia", o.inertia,
                 "Replace a robot's inertials by those of its links' shapes (those that the bodies "
                 "stand for), spread evenly: exact integrals over closed meshes, boxes and round "
                 "shapes, with bounds in the report. mass: links keep the masses that their file "
                 "states; or a density [kg/m^3] [what the file says stays]")
      ->type_name("mass|DENSITY");
  app.add_option(
         "--depfile", o.depfile,
         "Write a Makefile dependency rule; names that have no place in one are refused. If "
         "FILE ends in .list: the inputs, each followed by a zero byte")
      ->type_name("FILE");
  add_input_format(app, o.input_format, "Format of INPUT [by extension]");
  add_set_format_option(app, o.output_format);
  add_common_options(app, o.common);
  app.footer(
      "The union of the bodies contains the solid of INPUT and every one of its triangles; this "
      "is decided exactly on the bytes that are written. An open INPUT is closed by filling its "
      "holes first. With --direction inner, every body lies inside the solid instead.\n"
      "Exit codes: 0 done; 1 epsilon is not reached, or not within the limits or with "
      "--min-thickness or --max-aspect (the best result is written); 2 usage; 3 bad input; 4 "
      "output failed; 5 "
      "not built; 6 internal error; 7 limit (epsilon is not reached with --max-work: the best "
      "result is written).");
}

void require_meaning(const CLI::App& app, const DecomposeOptions& o) {
  require_none(certify::contradiction(o.set, o.stated));
  if (o.set.preparation.mode != certify::PreparationOptions::Mode::Auto)
    require_absent(app, "--prepare", {"--require-closed"});
  if (is_robot(o.input))
    require_absent(app, "a robot (.urdf), which states its meshes' scales itself", {"--scale"});
  else
    require_options_of_meshes(app, o.input);
  if (!is_robot(o.input) && o.srdf)
    throw Error(ErrorCode::InvalidArgument, "--srdf is for robots (.urdf, .xacro, .xml, .sdf); " +
                                                o.input + " is taken for a mesh");
  if (app.count("--inertia") != 0) density_of(o.inertia);
  if (!is_robot(o.input) && !o.inertia.empty())
    throw Error(
        ErrorCode::InvalidArgument,
        "--inertia is for robots (.urdf, .xacro, .xml, .sdf); " + o.input + " is taken for a mesh");
  if (!o.inertia.empty() && o.set.request.body_kind != certify::SetRequest::BodyKind::Polytopes)
    throw Error(ErrorCode::InvalidArgument, "--inertia needs --bodies polytopes of a robot");
  for (const char* budget : {"--robot-bodies", "--robot-vertices"}) {
    if (app.count(budget) == 0) continue;
    if (!is_robot(o.input))
      throw Error(ErrorCode::InvalidArgument, std::string(budget) +
                                                  " is for robots (.urdf, .xacro, .xml, .sdf); " +
                                                  o.input + " is taken for a mesh");
    require_absent(
        app, budget,
        {"--epsilon", "--epsilons", "--epsilon-map", "--max-bodies", "--max-total-vertices"});
  }
  if (app.count("--share") != 0 &&
      o.set.request.body_kind != certify::SetRequest::BodyKind::Spheres)
    throw Error(ErrorCode::InvalidArgument, "--share is for --bodies spheres");
  if (!o.pairs.empty() &&
      (!is_robot(o.input) || o.set.request.body_kind != certify::SetRequest::BodyKind::Spheres))
    throw Error(ErrorCode::InvalidArgument, "--pairs is for --bodies spheres of a robot");
  if (is_scene(o.preview) &&
      (!is_robot(o.input) || o.set.request.body_kind == certify::SetRequest::BodyKind::Polytopes))
    throw Error(ErrorCode::InvalidArgument,
                "--preview with a scene (.glb) shows spheres, capsules and boxes of a robot; "
                "polytopes are in one anyway: name a page (.html) or a picture (.png)");
  if (!o.repair.empty()) {
    if (!is_robot(o.input))
      throw Error(ErrorCode::InvalidArgument,
                  "--repair is for robots (.urdf, .xacro); " + o.input + " is taken for a mesh");
    std::vector<std::string> others{
        "--bodies",   "--epsilons", "--epsilon-map", "--robot-bodies", "--robot-vertices",
        "--srdf",     "--preview",  "--html-report", "--robot-format", "--for",
        "--no-cache", "--inertia",  "--pairs"};
    for (const auto& option : certify::set_options())
      if (option.name != "epsilon" && option.name != "effort" && option.name != "geometry")
        others.push_back("--" + std::string(option.name));
    require_absent(app, "--repair", others);
  }
  if (o.srdf) require_absent(app, "--srdf, which is about all links,", {"--links"});
  if (!is_robot(o.input) && app.count("--from") != 0)
    throw Error(ErrorCode::InvalidArgument, "--from is for robots (.urdf, .xacro, .xml, .sdf); " +
                                                o.input + " is taken for a mesh");
  if (is_page(o.preview)) require_absent(app, "--preview with a page", {"--explode"});
  if (is_page(o.preview) && o.input == "-")
    throw Error(ErrorCode::InvalidArgument,
                "--preview: a page shows the input as well, which is read again for that: name a "
                "file instead of standard input, or a picture (.png)");
}

void apply_preset(const CLI::App& app, DecomposeOptions& o) {
  if (!is_robot(o.input)) return;
  const bool stated = o.set.request.thickness.has_value();
  apply_preset(app, o.output, o.robot, &o.set.request.thickness);
  if (stated || !o.set.request.thickness) return;
  for (const char* option : {"--max-facets-per-body", "--max-total-vertices"})
    if (app.count(option) != 0)
      throw Error(ErrorCode::InvalidArgument,
                  "--for " + o.robot.preset + " means --min-thickness " +
                      o.set.request.thickness->text() + ", which does not go with " + option +
                      ": leave that out, or state what else --for means (--robot-format mjcf)");
}

}  // namespace kaboum::tools
