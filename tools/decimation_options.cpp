// The options of bmesh-decimate, and the request that they make.

#include "decimation_options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <map>

#include "result_files.h"

namespace kaboum::tools {
namespace {

const std::map<std::string, bmesh::Direction> kDirections{{"outer", bmesh::Direction::Outer},
                                                          {"inner", bmesh::Direction::Inner},
                                                          {"any", bmesh::Direction::Any}};
const std::map<std::string, bmesh::Cost> kCosts{{"distance", bmesh::Cost::Distance},
                                                {"mean", bmesh::Cost::Mean},
                                                {"planes", bmesh::Cost::Planes},
                                                {"planes-adapted", bmesh::Cost::PlanesAdapted},
                                                {"planes-diagonal", bmesh::Cost::PlanesDiagonal},
                                                {"triangles", bmesh::Cost::Triangles}};
const std::map<std::string, bmesh::Effort> kEfforts{{"fast", bmesh::Effort::Fast},
                                                    {"normal", bmesh::Effort::Normal},
                                                    {"best", bmesh::Effort::Best}};
const std::map<std::string, certify::MeshRequest::Numbers> kNumbers{
    {"auto", certify::MeshRequest::Numbers::Auto},
    {"float", certify::MeshRequest::Numbers::Float},
    {"double", certify::MeshRequest::Numbers::Double}};

void require(bool condition, const char* message) {
  if (!condition) throw Error(ErrorCode::InvalidArgument, message);
}

void describe_results(CLI::App& app, DecimationOptions& o) {
  app.add_option(
         "INPUT", o.input,
         "Mesh to simplify (- for stdin), or a robot (.urdf, .xacro), every mesh of every link")
      ->type_name("FILE");
  app.add_option(
         "-o,--output", o.output,
         "Where the result goes (- for stdout); {vertices} in the name stands for the wished "
         "number of vertices; of robots a folder, which gets a URDF and the meshes that it refers "
         "to")
      ->type_name("FILE");
  app.add_option("--direction", o.direction,
                 "outer: the result encloses the input; inner: the input encloses the result; any: "
                 "neither, for comparison [outer]")
      ->check(CLI::IsMember({"outer", "inner", "any"}).description(""))
      ->type_name("outer|inner|any");
  app.add_option(
         "--vertices", o.vertices,
         "Stop at this many vertices (at least 4). Several numbers, as in 20000,10000,5000, "
         "give a series in one pass: each result encloses (inner: is enclosed by) the finer "
         "ones; the output's name then contains {vertices}")
      ->check([](const std::string& s) {
        return parse_counts(s) ? std::string()
                               : "must be a number of vertices from 4 on, or different ones "
                                 "separated by commas, without blanks";
      })
      ->type_name("N[,N...]");
  app.add_option("--progressive", o.progressive,
                 "Also write the mesh, all steps and the levels of --vertices to this file: any "
                 "number of vertices can be taken from it later, and bound-verify progressive "
                 "checks it")
      ->type_name("FILE");
  app.add_option("--from", o.from,
                 "Instead of INPUT: take results from this progressive file, without computing "
                 "anything anew. Of a robot: collision or visual, the same as --geometry")
      ->type_name("FILE");
  app.add_option("--ratio", o.ratio,
                 "Stop at this fraction of the input's welded vertices (0 < R < 1)")
      ->check([](const std::string& s) {
        double r = 0;
        return CLI::detail::lexical_cast(s, r) && r > 0 && r < 1 ? std::string()
                                                                 : "must lie between 0 and 1";
      })
      ->type_name("R");
  app.add_option("--epsilon", o.epsilon,
                 "Keep every point of either surface within this distance of the other: a length "
                 "in the mesh's unit, or a "
                 "percentage of the bounding box's diagonal, as in 0.5%")
      ->check([](const std::string& s) {
        return parse_length(s) ? std::string()
                               : "must be a positive number, or a percentage such as 0.5%, "
                                 "without blanks or units";
      })
      ->type_name("LENGTH|P%");
}

void describe_search(CLI::App& app, DecimationOptions& o) {
  app.add_option(
         "--cost", o.cost,
         "Cost of a contraction. distance: the measured distance, for a small largest distance; "
         "mean: for a small mean distance; planes and the others: the thesis's, faster, and go "
         "on to fewer vertices, with spikes [distance]")
      ->check(CLI::IsMember(
                  {"planes", "planes-adapted", "planes-diagonal", "triangles", "distance", "mean"})
                  .description(""))
      ->type_name("planes|planes-adapted|planes-diagonal|triangles|distance|mean");
  app.add_option("--effort", o.effort,
                 "Tightness against time. fast: contractions only; normal and best: vertices are "
                 "also pulled back towards the input and edges flipped, many times slower (not "
                 "with --keep-convex, nor for open meshes) [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  app.add_option("--max-work", o.max_work,
                 "End after so much work, counted in steps that take about so many seconds of one "
                 "core, so that the result is the same on any machine; the best result so far is "
                 "written, and encloses as ever [12, and 2 per 1000 triangles beyond 10000; no "
                 "limit with --effort best]")
      ->check(number_from(0.001, 1e9))
      ->type_name("SECONDS");
  app.add_flag("--as-printed", o.as_printed,
               "With the thesis's formulas as printed, to reproduce its tables (only with --cost "
               "planes-diagonal)");
  app.add_option(
         "--precision", o.precision,
         "Numbers of the result's coordinates; auto: float, or double where float is too coarse "
         "and the format can hold it [auto]")
      ->check(CLI::IsMember({"auto", "float", "double"}).description(""))
      ->type_name("auto|float|double");
  app.add_option("--sharp-angle", o.sharp_angle,
                 "Edges whose normals differ by more degrees than this resist growing spikes; 180: "
                 "none (only with --cost planes, planes-adapted and planes-diagonal) [90]")
      ->check(number_from(0, 180))
      ->type_name("DEG");
  app.add_flag("--keep-convex", o.keep_convex, "Convex in, convex out, exactly");
}

void describe_files(CLI::App& app, DecimationOptions& o) {
  app.add_flag("--drop-sheets", o.prepare.drop_sheets,
               "Drop back-to-back faces without volume (they are then not enclosed)");
  add_holes_options(app, o.holes, true);
  add_preparation_options(app, o.preparation, "open meshes stay open", true);
  app.add_flag("--keep-orientation", o.prepare.keep_orientation,
               "Never turn inconsistent triangles or inside-out components");
  app.add_flag("--verify", o.verify,
               "Decide enclosure and distances anew, exactly and by independent means, before the "
               "result is written, against the input as prepared; a claim that does not hold gives "
               "exit code 1, an undecided one 7");
  app.add_option("--preview", o.preview,
                 "Write a page that shows results over the input in a browser, with distances in "
                 "colours (.html)")
      ->check(page_name())
      ->type_name("FILE");
  app.add_option("--log", o.log, "Write the log of all steps, for bmesh-replay")->type_name("FILE");
  app.add_option(
         "--depfile", o.depfile,
         "Write a Makefile dependency rule; names that have no place in one are refused. If "
         "FILE ends in .list: the inputs, each followed by a zero byte")
      ->type_name("FILE");
  app.add_option("--input-format", o.input_format, "Format of INPUT [by extension]")
      ->type_name("NAME");
  app.add_option("--output-format", o.output_format, "Format of the result [by extension]")
      ->type_name("NAME");
  add_unit_options(app, o.unit, "INPUT");
  add_robot_options(app, o.robot, false);
  app.add_flag("--no-cache", o.no_cache,
               "Of robots: neither use nor store results of earlier runs ($KABOUM_CACHE, else "
               "$XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum)");
  add_common_options(app, o.common);
  app.footer(
      "Give at least one of --vertices, --ratio and --epsilon; the first one reached stops. With "
      "--from: --vertices.\n"
      "With --prepare auto a mesh of which a triangle would not lie in the outer result, or that "
      "has "
      "no solid, is wrapped (not with --log, --progressive, --keep-orientation and --holes keep).\n"
      "Exit codes: 0 done: outer, every triangle of INPUT lies in the result; inner, every "
      "triangle "
      "of the result lies in the solid of INPUT; 1 the wished number of vertices cannot be reached "
      "(the best result is written), triangles stick out and no wrap may or can take the input's "
      "place (the result is written), the mesh is open and --holes keep leaves it so (the result "
      "is "
      "written and encloses nothing), float32 is too coarse here (nothing is written) or --verify "
      "found a claim that does not hold; 2 usage; 3 bad input; 4 output failed; 5 feature not "
      "built; 6 internal error; 7 limit reached (with --max-work the wished number of vertices, or "
      "what epsilon allows, is not reached, or whether a triangle sticks out is left open: the "
      "best "
      "result is written).");
}

}  // namespace

void describe(CLI::App& app, DecimationOptions& o) {
  describe_results(app, o);
  describe_search(app, o);
  describe_files(app, o);
}

const char* name_of(bmesh::Effort effort) {
  for (const auto& [name, value] : kEfforts)
    if (value == effort) return name.c_str();
  return "?";
}

void require_sound(const DecimationOptions& o, const std::vector<std::size_t>& counts) {
  require(!o.input.empty(), "give INPUT, or --from");
  require(!o.output.empty() || !o.progressive.empty(), "give -o for the result, or --progressive");
  require(!counts.empty() || o.ratio > 0 || !o.epsilon.empty(),
          "give at least one of --vertices, --ratio and --epsilon");
  require(counts.size() < 2 || o.ratio == 0,
          "several numbers of --vertices cannot be joined with --ratio");
  require(counts.size() < 2 || o.log.empty(),
          "--log speaks of one result; --progressive holds the steps of a series");
  require(o.progressive.empty() || o.log.empty(), "--progressive contains what --log writes");
  require(!o.preparation.wraps() || o.direction == "outer",
          "--prepare wrap: what lies in a wrap need not lie in the input; only --direction outer");
  require(!o.preparation.wraps() || !o.records(),
          "--log and --progressive start from the input; write the wrap with mesh-prepare first, "
          "and simplify that");
}

void require_sound_formats(const DecimationOptions& o, std::optional<io::Format> format) {
  require(o.precision != "double" || !format || io::holds_double(*format),
          "--precision double: the output format holds float32 only; write .ply, .obj or .off");
  require(!o.verify || o.direction != "any",
          "--verify: direction 'any' claims nothing that could be verified");
  require(o.progressive.empty() || o.direction != "any",
          "--progressive: direction 'any' claims nothing that the file could prove");
}

certify::MeshRequest request_of(const DecimationOptions& o, std::vector<std::size_t> counts,
                                std::optional<io::Format> format) {
  certify::MeshRequest r;
  r.direction = kDirections.at(o.direction);
  r.vertices = std::move(counts);
  if (o.ratio > 0) r.ratio = o.ratio;
  if (!o.epsilon.empty()) r.epsilon = parse_length(o.epsilon);
  r.cost = kCosts.at(o.cost);
  r.effort = kEfforts.at(o.effort);
  r.as_printed = o.as_printed;
  r.keep_convex = o.keep_convex;
  r.max_work = o.max_work;
  r.sharp_angle = o.sharp_angle;
  r.numbers = kNumbers.at(o.precision);
  r.format = format.value_or(io::Format::Ply);
  r.comment = std::string("bmesh-decimate ") + version() + o.unit.words();
  r.measure = !o.common.report.empty() || !o.preview.empty();
  r.decide = o.verify;
  r.record_steps = o.records();
  return r;
}

}  // namespace kaboum::tools
