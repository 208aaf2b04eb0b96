#include "verify_progressive.h"

#include <kaboum/bmesh/progressive.h>
#include <kaboum/geom/error.h>
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

}  // namespace

int verify_progressive(const std::string& original, const std::string& original_format,
                       const std::string& progressive, const CommonOptions& common) {
  require_apart({{"--report", common.report}}, {original, progressive});
  std::vector<char> bytes;
  const io::ReadResult input =
      io::read_mesh(original, format_for(original, original_format, "--input-format"), &bytes);
  const bmesh::Progressive p = bmesh::parse_progressive(io::read_file(progressive), progressive);
  if (p.log.input_sha256 != io::sha256(bytes))
    throw Error(ErrorCode::InvalidInput,
                progressive + ": the file was made from another one than " + original);
  if (p.log.direction == Direction::Any)
    throw Error(ErrorCode::InvalidInput,
                progressive + ": direction 'any' claims nothing that could be verified");
  bytes = {};
  const verify::ReplayResult r = verify::replay_progressive(input.mesh, p);
  if (!common.report.empty()) {
    Json json{{"tool", "bound-verify"},
              {"version", version()},
              {"relation", "progressive"},
              {"verdict", r.verified ? "verified" : "refuted"},
              {"violation", r.violation},
              {"original", {{"file", original}, {"sha256", p.log.input_sha256}}},
              {"progressive", {{"file", progressive}, {"made_by", p.log.tool}}},
              {"direction", p.log.direction == Direction::Outer ? "outer" : "inner"},
              {"closed", r.closed},
              {"steps", r.steps},
              {"predicates", r.predicates},
              {"against_solids", r.against_original},
              {"dropped_triangles", r.dropped},
              {"turned_triangles", r.turned},
              {"filled_triangles", r.filled}};
    for (std::size_t i = 0; i < r.levels; ++i)
      json["levels"].push_back({{"wished", p.levels[i].wished},
                                {"vertices", p.levels[i].vertices},
                                {"steps", p.levels[i].steps}});
    json["resources"] = {{"user_seconds", user_seconds()}, {"peak_megabytes", peak_megabytes()}};
    write_json(common.report, json);
  }
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  if (!r.verified) {
    out << "refuted: " << r.violation << '\n';
    return kNo;
  }
  if (common.quiet) return kDone;
  for (std::size_t i = 0; i < r.levels; ++i)
    out << "level " << p.levels[i].wished << ": " << p.levels[i].vertices << " vertices after "
        << p.levels[i].steps << " steps\n";
  if (r.turned != 0)
    out << r.turned
        << " triangles of the original are turned as the file says; whether they should be is not "
           "checked\n";
  if (r.filled != 0)
    out << "the original's holes are filled with " << r.filled
        << " triangles that the file adds to its own; it is closed with them, fans on the rims of "
           "its holes\n";
  if (r.dropped != 0) out << r.dropped << " triangles of the original are dropped, harmlessly\n";
  out << "verified: " << claim(p, r) << "; " << r.steps << " steps, " << r.predicates
      << " exact tests\n";
  return kDone;
}

}  // namespace kaboum::tools
