// What is claimed of a bounding mesh, and what each claim rests on.

#include <kaboum/certify/mesh.h>

#include <algorithm>

namespace kaboum::certify {
namespace {

using Kind = Claim::Kind;
using verify::Answer;

Claim surface_claim(const MeshCertificate& c) {
  return {Kind::Surface, c.decided ? Basis::Bytes : Basis::Meshes, c.surface->claim.answer,
          c.surface->claim.reason};
}

void add_distances(const MeshCertificate& c, std::vector<Claim>& claims) {
  if (c.decided) {
    claims.push_back({Kind::OriginalToResult,
                      Basis::Bytes,
                      c.decided->original_to_result,
                      {},
                      c.decided->distance_bound});
    claims.push_back({Kind::ResultToOriginal,
                      Basis::Bytes,
                      c.decided->result_to_original,
                      {},
                      c.decided->distance_bound});
  } else if (c.original_to_result) {
    claims.push_back({Kind::OriginalToResult,
                      Basis::Measured,
                      Answer::Verified,
                      {},
                      c.original_to_result->max_upper});
    claims.push_back({Kind::ResultToOriginal,
                      Basis::Measured,
                      Answer::Verified,
                      {},
                      c.result_to_original->max_upper});
  }
}

}  // namespace

double MeshCertificate::hausdorff_upper() const {
  return std::max(original_to_result->max_upper, result_to_original->max_upper);
}

verify::Answer MeshCertificate::surface_answer() const {
  return surface ? surface->claim.answer : Answer::Undefined;
}

bool MeshCertificate::reached() const {
  return (stop != bmesh::Stop::Exhausted && stop != bmesh::Stop::OutOfWork) || !requested ||
         vertices <= *requested;
}

Certificate certificate_of(const CertifiedMesh& mesh) {
  const MeshCertificate& c = mesh.certificate();
  Certificate out;
  out.direction = c.direction == bmesh::Direction::Any     ? Certificate::Direction::Any
                  : c.direction == bmesh::Direction::Inner ? Certificate::Direction::Inner
                                                           : Certificate::Direction::Outer;
  out.subject = in_words(c.subject);
  if (c.original_to_result && c.result_to_original)
    out.distance = {std::max(c.original_to_result->max_lower, c.result_to_original->max_lower),
                    c.hausdorff_upper()};
  if (c.direction == bmesh::Direction::Any) return out;
  std::vector<Claim>& all = out.claims;
  const Kind kind = c.closed ? Kind::Solid : Kind::Winding;
  if (c.decided) {
    const verify::Claim& solid = c.decided->inclusion.solid;
    all.push_back({kind, Basis::Bytes, solid.answer, solid.reason});
  } else {
    all.push_back({kind, Basis::Steps, Answer::Verified});
  }
  if (c.finer > 0) {
    const bool by_bytes = c.decided && c.decided->nested;
    all.push_back({Kind::Nested, by_bytes ? Basis::Bytes : Basis::Steps,
                   by_bytes ? *c.decided->nested : Answer::Verified});
  }
  if (c.surface) all.push_back(surface_claim(c));
  add_distances(c, all);
  return out;
}

}  // namespace kaboum::certify
