// `bound-verify progressive`: replays a progressive file and says what was found.
#include "progressive.h"

#include <kaboum/base/error.h>
#include <kaboum/bmesh/progressive.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/replay.h>

#include <iostream>

namespace kaboum::tools {
namespace {

using bmesh::Direction;

std::string claim(const bmesh::Progressive& p, const verify::ReplayResult& r) {
  const bool outer = p.log.direction == Direction::Outer;
  std::string text;
  if (!r.closed)
    text = std::string("the generalised winding number nowhere ") + (outer ? "falls" : "rises") +
           " from the original to the first level and from each level to the next (open mesh)";
  else
    text = std::string("the solid of each level ") + (outer ? "contains" : "is contained in") +
           " that of the level before, and of the original";
  return text;
}

/// What was asked, of which files, and what was found.
struct ProgressiveCase {
  const std::string &original, &file;
  double scale;                           // of the original
  const std::vector<std::string>& notes;  // on it
  const std::string& about_import;        // io::about_import, of it
  const bmesh::Progressive& progressive;
  const verify::ReplayResult& result;
};

Json report_of(const ProgressiveCase& run) {
  const verify::ReplayResult& r = run.result;
  const bmesh::Progressive& p = run.progressive;
  Json json{{"relation", "progressive"},
            {"verdict", r.verified ? "verified" : "refuted"},
            {"violation", r.violation},
            {"original",
             {{"file", run.original},
              {"sha256", p.log.input_sha256},
              {"scale", run.scale},
              {"notes", run.notes}}},
            {"progressive", {{"file", run.file}, {"made_by", p.log.tool}}},
            {"direction", p.log.direction == Direction::Outer ? "outer" : "inner"},
            {"closed", r.closed},
            {"steps", r.steps},
            {"predicates", r.predicates},
            {"against_solids", r.against_original},
            {"dropped_triangles", r.dropped},
            {"turned_triangles", r.reversed},
            {"filled_triangles", r.filled}};
  for (std::size_t i = 0; i < r.levels; ++i)
    json["levels"].push_back({{"wished", p.levels[i].requested},
                              {"vertices", p.levels[i].vertices},
                              {"steps", p.levels[i].steps}});
  return json;
}

/// What is said of a file that is verified.
std::vector<std::string> lines_of(const ProgressiveCase& run) {
  const verify::ReplayResult& r = run.result;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < r.levels; ++i) {
    const auto& level = run.progressive.levels[i];
    lines.push_back("level " + std::to_string(level.requested) + ": " +
                    std::to_string(level.vertices) + " vertices after " +
                    std::to_string(level.steps) + " steps");
  }
  if (r.reversed != 0)
    lines.push_back(std::to_string(r.reversed) +
                    " triangles of the original are turned as the file says; whether they should "
                    "be is not checked");
  if (r.filled != 0)
    lines.push_back("the original's holes are filled with " + std::to_string(r.filled) +
                    " triangles that the file adds to its own; it is closed with them, fans on the "
                    "rims of its holes");
  if (r.dropped != 0)
    lines.push_back(std::to_string(r.dropped) +
                    " triangles of the original are dropped, harmlessly");
  lines.push_back("verified: " + claim(run.progressive, r) + run.about_import + "; " +
                  std::to_string(r.steps) + " steps, " + std::to_string(r.predicates) +
                  " exact tests");
  return lines;
}

}  // namespace

int verify_progressive(const VerifyProgressiveOptions& o, const CommonOptions& common) {
  const auto& [original, original_format, progressive, unit] = o;
  require_apart({{"--report", common.report}}, {original, progressive});
  std::vector<char> bytes;
  io::ReadResult input = io::read_mesh(original, format_for(original, original_format), &bytes);
  const bmesh::Progressive p = bmesh::parse_progressive(io::read_file(progressive), progressive);
  if (p.log.input_sha256 != io::sha256(bytes))
    throw Error(ErrorCode::InvalidInput,
                progressive + ": the file was made from another one than " + original);
  if (p.log.direction == Direction::Any)
    throw Error(ErrorCode::InvalidInput,
                progressive + ": direction 'any' claims nothing that could be verified");
  io::require_recorded_scale(progressive, p.log.tool, unit.scale);
  apply(input, unit, original);
  bytes = {};
  const verify::ReplayResult r = verify::replay_progressive(input.mesh, p);
  const std::string about = io::about_import(input);
  const ProgressiveCase run{original, progressive, unit.scale, input.notes, about, p, r};
  for (const std::string& note : input.notes)
    log(common.quiet, std::string(original).append(": ").append(note));
  if (!common.report.empty()) write_report(common, "bound-verify", report_of(run));
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  if (!r.verified)
    out << "refuted: " << r.violation << '\n';
  else if (!common.quiet)
    for (const std::string& line : lines_of(run)) out << line << '\n';
  return r.verified ? kDone : kNo;
}

}  // namespace kaboum::tools
