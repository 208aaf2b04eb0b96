// The options of bmesh-decimate, and the request that they make.

#include "options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"

namespace kaboum::tools {
namespace {

void require(bool condition, const char* message) {
  if (!condition) throw Error(ErrorCode::InvalidArgument, message);
}

void describe_results(CLI::App& app, DecimationOptions& o) {
  app.add_option(
         "INPUT", o.input,
         "Mesh to simplify (- for stdin), or a robot (.urdf, .xacro, .xml, .sdf), every mesh of "
         "every link")
      ->type_name("FILE");
  app.add_option(
         "-o,--output", o.output,
         "Where the result goes (- for stdout); {vertices} in the name stands for the wished "
         "number of vertices; of robots a folder, which gets a URDF and the meshes that it refers "
         "to")
      ->type_name("FILE");
  app.add_option("--progressive", o.progressive,
                 "Also write the mesh, all steps and the levels of --vertices to this file: any "
                 "number of vertices can be taken from it later, and bound-verify progressive "
                 "checks it")
      ->type_name("FILE");
  app.add_option("--from", o.from,
                 "Instead of INPUT: take results from this progressive file, without computing "
                 "anything anew. Of a robot: collision or visual, the same as --geometry")
      ->type_name("FILE");
}

void describe_files(CLI::App& app, DecimationOptions& o) {
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
  add_input_format(app, o.input_format, "Format of INPUT [by extension]");
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
  add_request_options(app, certify::mesh_options(), o.mesh, o.stated);
  add_require_closed(app, o.mesh.preparation);
  describe_files(app, o);
}

void require_sound(const DecimationOptions& o) {
  require(!o.input.empty(), "give INPUT, or --from");
  require(!o.output.empty() || !o.progressive.empty(), "give -o for the result, or --progressive");
  require_none(certify::contradiction(o.mesh, o.stated));
  require(o.mesh.request.vertices.size() < 2 || o.log.empty(),
          "--log speaks of one result; --progressive holds the steps of a series");
  require(o.progressive.empty() || o.log.empty(), "--progressive contains what --log writes");
  require(!o.wraps() || !o.records(),
          "--log and --progressive start from the input; write the wrap with mesh-prepare first, "
          "and simplify that");
}

void require_sound_formats(const DecimationOptions& o, std::optional<io::Format> format) {
  using Numbers = certify::MeshRequest::Numbers;
  require(o.mesh.request.numbers != Numbers::Double || !format || io::holds_double(*format),
          "--precision double: the output format holds float32 only; write .ply, .obj or .off");
  require(o.progressive.empty() || o.mesh.request.direction != bmesh::Direction::Any,
          "--progressive: direction 'any' claims nothing that the file could prove");
}

certify::MeshOptions mesh_options_of(const DecimationOptions& o, std::optional<io::Format> format) {
  certify::MeshOptions out = o.mesh;
  out.request.format = format.value_or(io::Format::Ply);
  out.request.comment = std::string("bmesh-decimate ") + version() + o.unit.words();
  out.request.measure |= !o.common.report.empty() || !o.preview.empty();
  out.request.record_steps = o.records();
  return out;
}

}  // namespace kaboum::tools
