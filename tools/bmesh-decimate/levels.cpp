// Meshes out of a progressive file: bmesh-decimate --from.

#include "levels.h"

#include <kaboum/base/error.h>
#include <kaboum/bmesh/extract.h>
#include <kaboum/certify/mesh_bytes.h>
#include <kaboum/geom/float32.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>

#include "common/result_files.h"

namespace kaboum::tools {
namespace {

/// A mesh taken from a progressive file.
struct ExtractedLevel {
  std::size_t requested;
  std::string file;
  bmesh::Extracted extracted;
  std::vector<char> bytes;
};

bool is_float32(const geom::Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const geom::Vec3& p) { return geom::is_float32(p); });
}

/// The levels whose meshes have float32 coordinates, finest first.
std::string float32_levels(const bmesh::Progressive& p, const std::string& name) {
  std::string text;
  if (p.double_precision) return text;
  for (const bmesh::Progressive::Level& level : p.levels)
    if (is_float32(bmesh::extract(p, level.requested, name).mesh))
      text += (text.empty() ? "" : ", ") + std::to_string(level.requested);
  return text;
}

const char* name_of(bmesh::Direction direction) {
  switch (direction) {
    case bmesh::Direction::Outer:
      return "outer";
    case bmesh::Direction::Inner:
      return "inner";
    case bmesh::Direction::Any:
      break;
  }
  return "any";
}

Json report(const ExtractOptions& o, const bmesh::Progressive& p, const std::string& sha256,
            const std::vector<ExtractedLevel>& all) {
  Json r{{"from",
          {{"file", o.from},
           {"sha256", sha256},
           {"made_by", p.log.tool},
           {"input_sha256", p.log.input_sha256},
           {"direction", name_of(p.log.direction)}}}};
  for (const ExtractedLevel& t : all) {
    Json entry{{"vertices", t.requested},
               {"reached", t.extracted.reached},
               {"is_level", t.extracted.level},
               {"steps", t.extracted.steps},
               {"output", {{"file", t.file}}}};
    entry["output"].update(to_json(geom::analyse(t.extracted.mesh)));
    r["levels"].push_back(entry);
  }
  return r;
}

}  // namespace

int extract_levels(const ExtractOptions& o) {
  if (o.vertices.empty()) throw Error(ErrorCode::InvalidArgument, "--from needs --vertices");
  if (o.output.empty()) throw Error(ErrorCode::InvalidArgument, "--from needs -o for the result");
  const std::vector<std::size_t>& counts = o.vertices;
  const std::vector<std::string> files = level_files(o.output, counts);
  std::vector<std::pair<std::string, std::string>> outputs{{"--report", o.common.report},
                                                           {"--depfile", o.depfile}};
  for (const std::string& file : files) outputs.emplace_back("the result", file);
  require_apart(outputs, {o.from});
  const io::Format format = format_for(o.output, o.format, "--output-format");

  std::vector<char> bytes = io::read_file(o.from);
  const std::string sha256 = o.common.report.empty() ? std::string() : io::sha256(bytes);
  const bmesh::Progressive p = bmesh::parse_progressive(bytes, o.from);
  bytes = {};
  std::vector<ExtractedLevel> all;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    ExtractedLevel& t = all.emplace_back(
        ExtractedLevel{counts[i], files[i], bmesh::extract(p, counts[i], o.from), {}});
    const bool double_precision = p.double_precision || !is_float32(t.extracted.mesh);
    if (double_precision && !io::holds_double(format)) {
      const std::string levels = float32_levels(p, o.from);
      log(false, "bmesh-decimate: " + o.from + ": the mesh of " + std::to_string(t.requested) +
                     " vertices has coordinates that are no float32 numbers; nothing is written. "
                     "Write .ply, .obj, .off or (--output-format) stl-ascii, which hold doubles" +
                     (levels.empty() ? "" : "; or take one of the levels " + levels));
      return kNo;
    }
    t.bytes = certify::serialise_checked(t.extracted.mesh, format, double_precision, p.log.tool);
  }

  std::vector<std::pair<std::string, std::function<void()>>> writes;
  writes.emplace_back(o.common.report,
                      [&] { write_report(o.common, "bmesh-decimate", report(o, p, sha256, all)); });
  writes.emplace_back(o.depfile, [&] { write_depfile(o.depfile, files, {o.from}); });
  for (const ExtractedLevel& t : all)
    writes.emplace_back(t.file, [&t] { io::write_file(t.file, t.bytes); });
  write_together(writes);

  int code = kDone;
  for (const ExtractedLevel& t : all) {
    const std::size_t vertices = t.extracted.mesh.vertices.size();
    log(o.common.quiet, t.file + ": " + std::to_string(p.base.vertices.size()) + " → " +
                            std::to_string(vertices) + " vertices, " + name_of(p.log.direction) +
                            (t.extracted.level ? ", a level" : ", between levels") + " of " +
                            o.from);
    if (t.extracted.reached) continue;
    log(false, "bmesh-decimate: " + o.from + ": " + std::to_string(t.requested) +
                   " vertices cannot be reached: its steps end at " + std::to_string(vertices) +
                   "; that mesh is written");
    code = kNo;
  }
  return code;
}

}  // namespace kaboum::tools
