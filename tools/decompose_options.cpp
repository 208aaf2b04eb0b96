// The options of bcd-decompose by group, and what they ask for.

#include "decompose_options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>

#include "set_format.h"
#include "unit_option.h"

namespace kaboum::tools {
namespace {

void add_input(CLI::App& app, DecomposeOptions& o) {
  app.add_option("INPUT", o.input,
                 "Mesh or STEP file to decompose (- for stdin), or a robot (.urdf, .xacro), every "
                 "link of it")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", o.output,
                 "Where the bodies go: a .glb container, an .obj with one object per body, or a "
                 "folder with one STL per body (- for stdout); for robots a folder, which gets a "
                 "URDF, the bodies that it refers to, and a container per link")
      ->required()
      ->type_name("PATH");
}

void add_limits(CLI::App& app, DecomposeOptions& o) {
  app.add_option("--epsilon", o.epsilon,
                 "Fewest bodies with no point farther than this from the solid: a length in the "
                 "mesh's unit, or a percentage of the bounding box's diagonal, as in 0.5% [1% "
                 "unless --max-bodies or --max-total-vertices is given]")
      ->check([](const std::string& s) {
        return parse_length(s) ? std::string()
                               : "must be a positive number, or a percentage such as 0.5%, "
                                 "without blanks or units";
      })
      ->type_name("LENGTH|P%");
  app.add_option("--max-bodies", o.max_bodies,
                 "Look for the smallest distance with at most this many bodies (1 to 100000; of a "
                 "robot, for each of its meshes)")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N");
  app.add_option("--max-vertices-per-body", o.max_vertices,
                 "Most vertices of a body (8 to 100000); physics engines take 64 or 255")
      ->check(CLI::Range(8, 100000).description(""))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--simplify", o.simplify,
                 "Share of epsilon that leaving out vertices may take (0 to 1): with 0.25, bodies "
                 "have up to half as many vertices more and collide falsely less often; not with "
                 "--max-total-vertices [0.5]")
      ->check(number_from(0, 1))
      ->type_name("SHARE");
  app.add_option("--min-thickness", o.min_thickness,
                 "Thicken bodies that are less wide than this in some direction, for engines that "
                 "shrink hulls; counts towards epsilon [0]")
      ->check(number_from(0, 1e30))
      ->type_name("LENGTH");
  app.add_option("--max-total-vertices", o.max_total,
                 "Smallest distance with at most this many vertices of all bodies together (8 to "
                 "10000000; of a robot, for each of its meshes), and at most --max-bodies where "
                 "that is given; searches longer")
      ->check(CLI::Range(8, 10000000).description(""))
      ->type_name("N");
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

void add_search(CLI::App& app, DecomposeOptions& o) {
  app.add_option("--direction", o.direction,
                 "outer: bodies that cover the solid; inner: bodies inside it, which leave out no "
                 "point deeper than epsilon (not of robots) [outer]")
      ->check(CLI::IsMember({"outer", "inner"}).description(""))
      ->type_name("outer|inner");
  app.add_option("--effort", o.effort, "How long to search [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  app.add_option("--max-work", o.max_work,
                 "End the search after so much work, counted in steps that take about so many "
                 "seconds of one core, so that the result is the same on any machine; what was "
                 "found is then checked and written [20, and 1 per 1000 triangles beyond 10000; no "
                 "limit with --effort best]")
      ->check(number_from(0.001, 1e9))
      ->type_name("SECONDS");
  app.add_option("--improve-work", o.improve_work,
                 "Within epsilon, look for fewer bodies until the search has done so much work, "
                 "counted in the same way; of a robot: the searches of all its meshes together "
                 "[30 of a robot, else no other limit; none with --effort best]")
      ->check(number_from(0, 1e9))
      ->type_name("SECONDS");
  app.add_option("--method", o.method,
                 "How to find bodies; the claims are the same. clusters (of triangles, as HACD "
                 "does) and voxels (cuts across the axes, as V-HACD does) are there to be compared "
                 "with [planes]")
      ->check(CLI::IsMember({"planes", "clusters", "voxels"}).description(""))
      ->type_name("planes|clusters|voxels");
  app.add_option("--pre-step", o.pre_step,
                 "Simplify the input first to a mesh round it, within a tenth of epsilon (0.1% "
                 "where none is given); distances remain those to the input; auto: above 20000 "
                 "triangles, if a quarter of the vertices suffices [auto]")
      ->check(CLI::IsMember({"auto", "on", "off"}).description(""))
      ->type_name("auto|on|off");
}

void add_output(CLI::App& app, DecomposeOptions& o) {
  app.add_option("--unit", o.unit,
                 "Unit of length, noted in the container: m, dm, cm, mm, um, km, in or ft")
      ->check(unit_name())
      ->capture_default_str()
      ->type_name("NAME");
  add_scale_option(app, o.scale, "INPUT");
  app.add_option("--frame", o.frame, "Coordinate frame, noted in the container")->type_name("NAME");
  app.add_option(
         "--preview", o.preview,
         "Write a picture of the bodies (.png), or a page that shows them over the input in "
         "a browser (.html)")
      ->check(preview_name())
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

void add_preparation(CLI::App& app, DecomposeOptions& o) {
  add_preparation_options(app, o.preparation, "open meshes are refused", true);
  app.add_flag("--drop-sheets", o.prepare.drop_sheets,
               "Drop back-to-back faces without volume (they are then not covered)");
  add_holes_options(app, o.holes, false);
  app.add_flag("--keep-orientation", o.prepare.keep_orientation,
               "Never turn inconsistent triangles or inside-out components");
}

}  // namespace

void describe(CLI::App& app, DecomposeOptions& o) {
  add_input(app, o);
  add_limits(app, o);
  add_search(app, o);
  add_output(app, o);
  add_preparation(app, o);
  add_robot_options(app, o.robot, true);
  add_budget(app, "--robot-bodies", o.robot_bodies, "bodies");
  add_budget(app, "--robot-vertices", o.robot_vertices, "vertices");
  app.add_flag(
      "--srdf", o.srdf,
      "Also write NAME.srdf beside a robot's URDF, which MoveIt reads: pairs of links that "
      "need no check, because they are connected or their bodies are proved never to "
      "touch, at whatever joint values within the limits (for one turn of joints without "
      "limits); not with --links");
  app.add_option(
         "--depfile", o.depfile,
         "Write a Makefile dependency rule; names that have no place in one are refused. If "
         "FILE ends in .list: the inputs, each followed by a zero byte")
      ->type_name("FILE");
  app.add_option("--input-format", o.input_format, "Format of INPUT [by extension]")
      ->type_name("NAME");
  add_set_format_option(app, o.output_format);
  add_common_options(app, o.common);
  app.footer(
      "The union of the bodies contains the solid of INPUT and every one of its triangles; this "
      "is decided exactly on the bytes that are written. An open INPUT is closed by filling its "
      "holes first. With --direction inner, every body lies inside the solid instead.\n"
      "Exit codes: 0 done; 1 epsilon is not reached, or not within the limits or with "
      "--min-thickness (the best result is written); 2 usage; 3 bad input; 4 output failed; 5 "
      "not built; 6 internal error; 7 limit (epsilon is not reached with --max-work: the best "
      "result is written).");
}

void require_meaning(const CLI::App& app, const DecomposeOptions& o) {
  require_meaning(app, o.preparation);
  const std::string given = "--prepare " + o.preparation.name;
  if (o.preparation.name != "auto") require_absent(app, given, {"--holes", "--require-closed"});
  if (o.preparation.wraps()) require_absent(app, given, {"--drop-sheets", "--keep-orientation"});
  if (o.preparation.wraps() && o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument,
                "--prepare wrap: what lies in a wrap need not lie in the input; only --direction "
                "outer");
  if (is_robot(o.input))
    require_absent(app, "a robot (.urdf), which states its meshes' scales itself", {"--scale"});
  else
    require_options_of_meshes(app, o.input);
  if (!is_robot(o.input) && o.srdf)
    throw Error(ErrorCode::InvalidArgument,
                "--srdf is for robots (.urdf, .xacro); " + o.input + " is taken for a mesh");
  for (const char* budget : {"--robot-bodies", "--robot-vertices"}) {
    if (app.count(budget) == 0) continue;
    if (!is_robot(o.input))
      throw Error(ErrorCode::InvalidArgument, std::string(budget) +
                                                  " is for robots (.urdf, .xacro); " + o.input +
                                                  " is taken for a mesh");
    require_absent(app, budget,
                   {"--epsilon", "--epsilons", "--max-bodies", "--max-total-vertices"});
  }
  if (o.srdf) require_absent(app, "--srdf, which is about all links,", {"--links"});
  if (!is_robot(o.input) && app.count("--from") != 0)
    throw Error(ErrorCode::InvalidArgument,
                "--from is for robots (.urdf, .xacro); " + o.input + " is taken for a mesh");
  if (is_page(o.preview)) require_absent(app, "--preview with a page", {"--explode"});
  if (is_page(o.preview) && o.input == "-")
    throw Error(ErrorCode::InvalidArgument,
                "--preview: a page shows the input as well, which is read again for that: name a "
                "file instead of standard input, or a picture (.png)");
  if (o.max_total > 0 && o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument, "--max-total-vertices needs --direction outer");
  if (o.pre_step == "on" && o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument, "--pre-step on needs --direction outer");
  for (const char* option : {"--simplify", "--improve-work"})
    if (app.count(option) != 0 && o.direction != "outer")
      throw Error(ErrorCode::InvalidArgument, std::string(option) + " needs --direction outer");
  if (o.simplify && o.max_total > 0)
    throw Error(ErrorCode::InvalidArgument,
                "--simplify means nothing with --max-total-vertices, which leaves out as many "
                "vertices as the distance allows");
}

void apply_preset(const CLI::App& app, DecomposeOptions& o) {
  if (is_robot(o.input)) apply_preset(app, o.output, o.robot, &o.min_thickness);
}

}  // namespace kaboum::tools
