// The solid that stands for triangles: as prepared, else that of a wrap round them.

#include "given_solid.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/preparation_doubt.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/subject.h>

#include <algorithm>

namespace kaboum::certify {

bool is_as_it_was(const geom::PreparationReport& r) {
  return r.reversed_triangles == 0 && r.collapsed_triangles == 0 && r.dropped_copies == 0 &&
         r.cancelled_walls == 0 && r.dropped_sheets == 0 && r.holes == 0 && !r.hollow;
}

std::string undecided_solid(const geom::Mesh& mesh, const geom::Prepared& prepared,
                            const geom::PrepareOptions& options, const geom::Mesh& outer) {
  if (options.keep_orientation)
    return geom::signed_volume(prepared.solid.mesh()) < 0
               ? "it is inside out: its volume is negative"
               : std::string();
  const verify::Subject subject = verify::subject_of(mesh, prepared);
  if (!subject.both_ways) return {};
  verify::Inclusion known;
  known.solid.answer = known.surface.answer = verify::Answer::Verified;
  const auto look = [&](const geom::Mesh& inner, bool surface_only) {
    verify::InclusionOptions limits;
    limits.surface_only = surface_only;
    limits.max_work = verify::usual_work(inner.triangles.size() + outer.triangles.size());
    return verify::verify_inclusion(inner, outer, limits);
  };
  const verify::Claim solid =
      verify::decide_rest(subject, subject.mesh, verify::Claims::All, std::move(known), look)
          .inclusion.solid;
  return solid.answer == verify::Answer::Verified ? std::string() : solid.reason;
}

geom::Mesh with_fillings(geom::Mesh mesh, const geom::SolidMesh& solid) {
  const geom::Mesh& filled = solid.mesh();
  for (std::size_t t = filled.triangles.size() - solid.filled_triangles();
       t < filled.triangles.size(); ++t) {
    const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t v : filled.triangles[t]) mesh.vertices.push_back(filled.vertices[v]);
    mesh.triangles.push_back({at, at + 1, at + 2});
  }
  return mesh;
}

geom::Mesh with_other_diagonals(geom::Mesh mesh, const geom::PrepareOptions& options) {
  if (options.diagonal == geom::PrepareOptions::Diagonal::AsGiven) return mesh;
  for (const std::uint32_t quad : options.quads) {
    const geom::Triangle s = mesh.triangles.at(quad), t = mesh.triangles.at(quad + 1);
    // All four corners, in any order: of their triangles two are there already.
    for (const std::uint32_t d : t) {
      if (std::find(s.begin(), s.end(), d) != s.end()) continue;
      for (int k = 0; k < 3; ++k) mesh.triangles.push_back({s[k], s[(k + 1) % 3], d});
    }
  }
  return mesh;
}

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
    out.wrapped = with_other_diagonals(mesh, options);
  } else {
    try {
      out.prepared = prepare(mesh, options);
      if (!if_needed) return out;
      out.why = because.empty() ? geom::doubt_about(out.prepared.report) : because;
      if (out.why.empty()) return out;
      out.wrapped = with_fillings(with_other_diagonals(mesh, options), out.prepared.solid);
    } catch (const Error& error) {
      if (!if_needed || error.code() != ErrorCode::InvalidInput) throw;
      out.why = error.what();
      out.why.resize(std::min(out.why.size(), out.why.find("; have a wrap")));  // as is done here
      out.wrapped = with_other_diagonals(mesh, options);
    }
  }
  try {
    out.wrap.emplace(make(out.wrapped));
    geom::PrepareOptions of_wrap = options;
    of_wrap.quads.clear();  // of the input
    out.prepared = prepare(out.wrap->artefact(), of_wrap);
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
