// The solid that stands for triangles: as prepared, else that of a wrap round them.

#include "given_solid.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/preparation_doubt.h>

#include <algorithm>

namespace kaboum::certify {
namespace {

/// The triangles, and those that fill its holes: a solid that is closed by these is wrapped, too.
geom::Mesh with_fillings(geom::Mesh mesh, const geom::SolidMesh& solid) {
  const geom::Mesh& filled = solid.mesh();
  const std::size_t first = filled.triangles.size() - solid.filled_triangles();
  for (std::size_t t = first; t < filled.triangles.size(); ++t) {
    const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t v : filled.triangles[t]) mesh.vertices.push_back(filled.vertices[v]);
    mesh.triangles.push_back({at, at + 1, at + 2});
  }
  return mesh;
}

/// Nothing of it is turned, dropped or hollow.
bool is_as_it_was(const geom::PreparationReport& r) {
  return r.reversed_triangles == 0 && r.collapsed_triangles == 0 && r.dropped_copies == 0 &&
         r.cancelled_walls == 0 && r.dropped_sheets == 0 && r.holes == 0 && !r.hollow;
}

}  // namespace

std::string why_wrapped(const std::string& why) {
  return "A wrap takes the place of the mesh, so that every triangle is inside all the same: " +
         why + ".";
}

GivenSolid give_solid(const geom::Mesh& mesh, Prepare prepare, const geom::PrepareOptions& options,
                      const std::optional<WrapRequest>& wrap,
                      const std::function<CertifiedWrap(const geom::Mesh&)>& make,
                      const std::string& because) {
  GivenSolid out;
  const bool if_needed = wrap && wrap->where_needed;
  if (wrap && !if_needed) {
    out.wrapped = mesh;
  } else {
    try {
      out.prepared = prepare(mesh, options);
      if (!if_needed) return out;
      out.why = because.empty() ? geom::doubt_about(out.prepared.report) : because;
      if (out.why.empty()) return out;
      out.wrapped = with_fillings(mesh, out.prepared.solid);
    } catch (const Error& error) {
      if (!if_needed || error.code() != ErrorCode::InvalidInput) throw;
      out.why = error.what();
      out.why.resize(std::min(out.why.size(), out.why.find("; have a wrap")));  // as is done here
      out.wrapped = mesh;
    }
  }
  try {
    out.wrap.emplace(make(out.wrapped));
    out.prepared = prepare(out.wrap->artefact(), options);
  } catch (const Error& error) {
    if (out.why.empty()) throw;
    throw Error(error.code(), out.why + "; and " + error.what());
  }
  // What is said of a wrap is ours to know.
  out.prepared.report.notes.clear();
  if (is_as_it_was(out.prepared.report)) out.wrapped = {};
  return out;
}

}  // namespace kaboum::certify
