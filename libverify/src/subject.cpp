// The mesh that claims about the triangles of a file are about.
#include <kaboum/base/error.h>
#include <kaboum/verify/subject.h>

#include <algorithm>
#include <utility>

namespace kaboum::verify {
namespace {

/// Both triangles of the other way to split each quad that is not plane.
void add_other_ways(const std::vector<std::uint32_t>& quads, geom::Mesh& mesh) {
  for (const std::uint32_t quad : quads) {
    const geom::Triangle first = mesh.triangles.at(quad), second = mesh.triangles.at(quad + 1);
    const auto in_second = [&](std::uint32_t v) {
      return std::find(second.begin(), second.end(), v) != second.end();
    };
    const auto apex =
        std::find_if(first.begin(), first.end(), [&](std::uint32_t v) { return !in_second(v); });
    const auto other = std::find_if(second.begin(), second.end(), [&](std::uint32_t v) {
      return std::find(first.begin(), first.end(), v) == first.end();
    });
    if (apex == first.end() || other == second.end()) continue;
    const auto k = apex - first.begin();
    mesh.triangles.push_back({*apex, first[(k + 1) % 3], *other});
    mesh.triangles.push_back({*apex, *other, first[(k + 2) % 3]});
  }
}

}  // namespace

geom::Mesh without_filling(geom::Mesh mesh, std::size_t filled_triangles) {
  mesh.triangles.resize(mesh.triangles.size() - filled_triangles);
  return mesh;
}

geom::Mesh turned(geom::Mesh mesh) {
  for (geom::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Subject unprepared_subject(const geom::Mesh& file) {
  Subject out;
  out.mesh = file;
  out.both_ways = true;
  return out;
}

Subject prepared_subject(const geom::Mesh& file, const geom::PrepareOptions& options) {
  try {
    geom::Prepared prepared = geom::prepare(file, options);
    Subject out;
    out.mesh = prepared.solid.mesh();
    out.filled_triangles = prepared.solid.filled_triangles();
    out.report = std::move(prepared.report);
    const geom::PreparationReport& r = out.report;
    out.has_more = r.dropped_sheets == 0 && r.collapsed_triangles + r.cancelled_walls > 0;
    if (out.has_more) out.triangles = file;
    return out;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput || options.drop_sheets) throw;
    Subject out = unprepared_subject(file);
    out.refusal = error.what();
    out.has_more =
        options.diagonal != geom::PrepareOptions::Diagonal::AsGiven && !options.quads.empty();
    if (!out.has_more) return out;
    out.triangles = file;
    add_other_ways(options.quads, out.triangles);
    return out;
  }
}

MeasuredMesh measured_mesh(const Subject& subject, const geom::Mesh& file) {
  const bool is_prepared = subject.refusal.empty() && !subject.report.source.empty();
  if (is_prepared && !subject.has_more) return {subject.mesh};
  MeasuredMesh out;
  try {
    out.mesh =
        is_prepared
            ? subject.mesh
            : geom::prepare(file, {.drop_sheets = true, .holes = geom::Holes::Fill}).solid.mesh();
  } catch (const Error&) {
    out.has_solid = false;
  }
  // All triangles, on both sides: their windings cancel.
  const geom::Mesh& all = subject.has_more ? subject.triangles : file;
  for (const geom::Mesh& mesh : {all, turned(all)}) {
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    out.mesh.vertices.insert(out.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const geom::Triangle& t : mesh.triangles)
      out.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return out;
}

}  // namespace kaboum::verify
