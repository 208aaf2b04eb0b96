// The program bmesh-replay: derives a result from its log and says whether it is the one at hand.

#include <kaboum/base/error.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/replay.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "common/cli.h"
#include "common/unit_option.h"

namespace {

using namespace kaboum;  // the tool's own names are few

struct Options {
  std::string original, log, result, result_format;
  tools::InputFormat original_format;
  double scale = 1;
  tools::CommonOptions common;
};

/// The original as the log interprets it: turns are taken from the log, not judged.
std::string original(const verify::ReplayResult& r) {
  std::string text = "the original";
  if (r.reversed != 0)
    text += ", with " + std::to_string(r.reversed) +
            " triangles turned as the log says (whether they should be is not checked)";
  if (r.filled != 0)
    text += ", its holes filled with " + std::to_string(r.filled) +
            " triangles that the log adds (it is closed with them, fans on the rims of its holes)";
  return text;
}

std::string claim(const bmesh::Log& log, const verify::ReplayResult& r) {
  if (log.direction == bmesh::Direction::Any)
    return "replayed; direction 'any' claims no enclosure";
  const bool outer = log.direction == bmesh::Direction::Outer;
  if (!r.closed)
    return std::string("verified: the generalised winding number of ") + original(r) + " nowhere " +
           (outer ? "falls" : "rises") + " (open mesh)";
  return outer ? "verified: the solid of the result contains that of " + original(r)
               : "verified: the solid of " + original(r) + " contains that of the result";
}

int check(const Options& o) {
  std::vector<char> bytes;
  io::ReadResult input =
      io::read_mesh(o.original, tools::format_for(o.original, o.original_format), &bytes);
  const bmesh::Log log = bmesh::parse_log(io::read_file(o.log), o.log);
  if (log.input_sha256 != io::sha256(bytes))
    throw Error(ErrorCode::InvalidInput,
                o.log + ": the log was made from another file than " + o.original);
  io::require_recorded_scale(o.log, log.tool, o.scale);
  io::scale(input, o.scale, o.original);
  for (const std::string& note : input.notes)
    tools::log(o.common.quiet, std::string(o.original).append(": ").append(note));
  bytes = {};
  const io::ReadResult result =
      io::read_mesh(o.result, tools::format_for(o.result, o.result_format, "--input-format"));
  tools::Progress progress(o.common.quiet);
  const verify::ReplayResult r = verify::replay(
      input.mesh, log, result.mesh, [&](const std::string& stage) { progress.show(stage); });
  tools::write_report(o.common, "bmesh-replay",
                      {{"verified", r.verified},
                       {"scale", o.scale},
                       {"notes", input.notes},
                       {"violation", r.violation},
                       {"closed", r.closed},
                       {"steps", r.steps},
                       {"predicates", r.predicates},
                       {"dropped_triangles", r.dropped},
                       {"turned_triangles", r.reversed},
                       {"filled_triangles", r.filled}});
  if (!r.verified) {
    std::cout << "refuted: " << r.violation << '\n';
    return tools::kNo;
  }
  std::string text = claim(log, r) + io::about_import(input) + "; " + std::to_string(r.steps) +
                     " steps, " + std::to_string(r.predicates) + " exact tests";
  if (r.dropped != 0) text += ", " + std::to_string(r.dropped) + " input triangles dropped";
  if (!o.common.quiet) std::cout << text << '\n';
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Derives the result of bmesh-decimate again from its log and checks every step exactly.",
      "bmesh-replay");
  Options o;
  app.add_option("ORIGINAL", o.original, "The mesh that was simplified")
      ->required()
      ->type_name("FILE");
  app.add_option("LOG", o.log, "The log that bmesh-decimate --log wrote")
      ->required()
      ->type_name("FILE");
  app.add_option("RESULT", o.result, "The mesh that it wrote")->required()->type_name("FILE");
  tools::add_input_format(app, o.original_format, "Format of ORIGINAL [by extension]");
  app.add_option("--result-format", o.result_format, "Format of RESULT [by extension]")
      ->type_name("NAME");
  tools::add_scale_option(app, o.scale, "ORIGINAL");
  tools::add_common_options(app, o.common);
  app.footer(
      "Exit codes: 0 verified; 1 refuted; 2 usage; 3 bad input; 4 output failed; 6 internal "
      "error.");
  return tools::run(app, argc, argv, [&] { return check(o); });
}
