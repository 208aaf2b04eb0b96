// What makes a certificate of a candidate: its bytes, read back; distances; libverify's answers
// about these bytes; and whether all triangles are where they should be.

#include "mesh_certifier.h"

#include <kaboum/base/error.h>
#include <kaboum/certify/mesh_bytes.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/loose_triangles.h>

#include <algorithm>
#include <limits>

#include "given_solid.h"
#include "issuer.h"
namespace kaboum::certify {
namespace {

/// Distances not far above rounding may take any number: then the bracket is wider.
constexpr std::size_t kMaxPieces = std::size_t{1} << 20;
/// Room above the measured distance that keeps the claim decidable: of it, and of the diagonal.
constexpr double kRoom = 1e-3, kLeastBound = 1e-6;
/// Vertices of the original that are looked at for being far from the result.
constexpr std::size_t kOutlierSamples = 1000;

bool refuted(verify::Answer answer) { return answer == verify::Answer::Refuted; }

}  // namespace

std::vector<CertifiedMesh> MeshCertifier::certify(std::vector<bmesh::DecimateResult> candidates) {
  const double work = candidates.empty()
                          ? 0
                          : work_for_surface(plan_.work, candidates.back().work, candidates.size());
  std::vector<Candidate> all;
  all.reserve(candidates.size());  // each looks at the one before
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // A number of vertices that was not reached is also what the next one got to.
    if (i > 0 && candidates[i].stop != bmesh::Stop::VertexTarget &&
        all.back().certificate.stop != bmesh::Stop::VertexTarget) {
      all.push_back(repeated(all.back(), i, plan_.vertices[i]));
      continue;
    }
    const Candidate* before = all.empty() ? nullptr : &all.back();
    Candidate made = begin(std::move(candidates[i]), i);
    if (plan_.epsilon || request_.decide || request_.measure) measure(made);
    if (request_.decide) decide(made, before);
    look_at_surface(made, work);
    made.certificate.outliers = outliers(made.mesh);
    all.push_back(std::move(made));
  }
  std::vector<CertifiedMesh> certified;
  certified.reserve(all.size());
  for (Candidate& c : all)
    certified.push_back(
        Issuer::issue(std::move(c.mesh), std::move(c.certificate), std::move(c.bytes)));
  return certified;
}

/// The result once more, for the next number of vertices.
MeshCertifier::Candidate MeshCertifier::repeated(const Candidate& from, std::size_t place,
                                                 std::size_t requested) {
  Candidate to = from;
  to.certificate.finer = place;
  to.certificate.requested = requested;
  if (to.certificate.decided) to.certificate.decided->nested.reset();
  return to;
}

MeshCertifier::Candidate MeshCertifier::begin(bmesh::DecimateResult candidate, std::size_t place) {
  Candidate made;
  MeshCertificate& c = made.certificate;
  c.direction = request_.direction;
  c.keep_convex = request_.keep_convex;
  c.closed = original_.solid.closed();
  c.subject = subject_of(original_.report);
  c.subject.wrapped = wrapped_ != nullptr;
  c.finer = place;
  if (!plan_.vertices.empty()) c.requested = plan_.vertices[place];
  c.vertices = candidate.mesh.vertices.size();
  c.stop = candidate.stop;
  c.statistics = candidate.statistics;
  c.out_of_work = candidate.out_of_work;
  steps_ += candidate.steps.size();
  c.steps = steps_;
  c.double_precision =
      plan_.precision == bmesh::Precision::Double || candidate.unrepresentable != 0;
  c.epsilon = plan_.epsilon;
  made.mesh = std::move(candidate.mesh);
  made.bytes = serialise_checked(made.mesh, request_.format, c.double_precision, request_.comment);
  return made;
}

void MeshCertifier::measure(Candidate& made) const {
  const geom::DistanceQuery original(original_.solid.mesh()), result(made.mesh);
  geom::DistanceOptions gap;
  gap.max_pieces = kMaxPieces;
  geom::DirectedDistance& forth = made.certificate.original_to_result.emplace(
      geom::directed_distance(original_.solid.mesh(), result, gap));
  geom::DirectedDistance& back = made.certificate.result_to_original.emplace(
      geom::directed_distance(made.mesh, original, gap));
  if (!plan_.epsilon) return;
  ensure(std::max(forth.max_lower, back.max_lower) <= *plan_.epsilon,
         "the measured distance exceeds the carried bound");
  // The bound carried through the contractions holds as well; the measured one may lie above it by
  // its gap.
  for (geom::DirectedDistance* d : {&forth, &back})
    d->max_upper = std::min(d->max_upper, *plan_.epsilon);
}

/// Decides the claims anew from the bytes that will be written, by other means than those that made
/// them. A refuted certificate is our bug.
void MeshCertifier::decide(Candidate& made, const Candidate* before) const {
  const io::ReadResult back = io::parse_mesh(made.bytes, request_.format, "the result");
  verify::InclusionOptions options;
  options.max_work = std::numeric_limits<double>::infinity();  // it has to be decided
  options.progress = [&](const std::string& what) { show("verifying: " + what); };
  const auto bounds = [&](const geom::Mesh& other) {
    return verify::verify_inclusion(outer() ? other : back.mesh, outer() ? back.mesh : other,
                                    options);
  };
  DecidedMesh decided;
  decided.inclusion = bounds(original_.solid.mesh());
  if (before != nullptr)
    decided.nested = bounds(io::parse_mesh(before->bytes, request_.format, "the level before").mesh)
                         .solid.answer;
  ensure(!refuted(decided.inclusion.solid.answer) && !(decided.nested && refuted(*decided.nested)),
         "the verification refutes that the result is bounding; nothing is written");
  show("verifying: distances");
  // Epsilon, or the measured bound with room that keeps it decidable.
  decided.distance_bound = plan_.epsilon
                               ? *plan_.epsilon
                               : std::max(made.certificate.hausdorff_upper() * (1 + kRoom),
                                          kLeastBound * plan_.diagonal);
  const auto within = [&](const geom::Mesh& from, const geom::Mesh& to) {
    const verify::Answer answer = verify::verify_distance(from, to, decided.distance_bound).answer;
    ensure(!refuted(answer), "the verification refutes the measured distance; nothing is written");
    return answer;
  };
  decided.original_to_result = within(original_.solid.mesh(), back.mesh);
  decided.result_to_original = within(back.mesh, original_.solid.mesh());
  made.certificate.decided = std::move(decided);
}

void MeshCertifier::look_at_surface(Candidate& made, double work) {
  MeshCertificate& c = made.certificate;
  if (!original_.solid.closed() || request_.direction == bmesh::Direction::Any) return;
  if (wrapped_ != nullptr) {
    // The wrap's solid holds them, and the result's the wrap's: decided, and certified by the
    // steps, if the solid that these started from is the wrap's.
    if (c.decided || !is_as_it_was(original_.report))
      c.surface = decided_surface(made);
    else
      c.surface.emplace().claim.answer = verify::Answer::Verified;
    ensure(!refuted(c.surface_answer()),
           "the verification refutes that the result of a wrap holds the input's triangles");
    return;
  }
  const geom::Mesh& from = outer() ? claimed_.mesh() : made.mesh;
  const geom::Mesh& to = outer() ? made.mesh : original_.solid.mesh();
  if (c.decided)
    c.surface = decided_surface(made);
  else
    c.surface = decide_surface(
        from, outer() ? claimed_.loose() : verify::find_loose_triangles(made.mesh), to, work);
  const bool all = c.surface->left_out == 0 && !(c.decided && c.decided->inclusion.limited);
  if (!refuted(c.surface_answer()) || !all) return;
  measure_sticking_out(from, to, work, *c.surface);
  if (!outer()) return;
  std::uint32_t& triangle = c.surface->sticks_out.triangle;
  triangle = claimed_.source(triangle);
  c.surface->at_filling = triangle == ClaimedSurface::kFill;
}

/// As decided from the bytes; walls, and what is in a wrap, are no part of that.
DecidedSurface MeshCertifier::decided_surface(const Candidate& made) {
  const double unlimited = std::numeric_limits<double>::infinity();
  DecidedSurface out;
  const auto decide_others = [&](const geom::Mesh& mesh, std::size_t first) {
    show("verifying: the input's triangles");
    std::vector<std::uint32_t> triangles;
    for (std::size_t t = first; t < mesh.triangles.size(); ++t)
      triangles.push_back(static_cast<std::uint32_t>(t));
    const io::ReadResult back = io::parse_mesh(made.bytes, request_.format, "the result");
    return decide_surface(mesh, triangles, back.mesh, unlimited);
  };
  if (wrapped_ != nullptr) return decide_others(*wrapped_, 0);
  const verify::Inclusion& inclusion = made.certificate.decided->inclusion;
  out.claim = inclusion.surface;
  out.left_out = inclusion.left_out;
  out.looked_at = outer() ? claimed_.mesh().triangles.size() : made.mesh.triangles.size();
  if (!outer() || original_.report.left_out.empty()) return out;
  const DecidedSurface walls =
      decide_others(claimed_.mesh(), original_.solid.mesh().triangles.size());
  if (walls.claim.answer == verify::Answer::Verified) return out;
  if (!refuted(out.claim.answer)) out.claim.reason = walls.claim.reason;
  out.claim.answer = verify::worse(out.claim.answer, walls.claim.answer);
  out.claim.inner_triangles.insert(out.claim.inner_triangles.end(),
                                   walls.claim.inner_triangles.begin(),
                                   walls.claim.inner_triangles.end());
  out.left_out += walls.left_out;
  return out;
}

/// Without epsilon nothing keeps vertices near the original: few of them mean spikes, or inwards
/// that little is left. Some vertices of the original tell without measuring it all.
Outliers MeshCertifier::outliers(const geom::Mesh& result) const {
  Outliers found;
  if (result.triangles.empty()) return found;
  const geom::Box3 box = geom::bounding_box(original_.solid.mesh()),
                   reached = geom::bounding_box(result);
  found.beyond_box =
      std::max((box.min - reached.min).maxCoeff(), (reached.max - box.max).maxCoeff());
  const geom::DistanceQuery surface(result);
  const std::vector<geom::Vec3>& vertices = original_.solid.mesh().vertices;
  for (std::size_t i = 0; i < vertices.size(); i += vertices.size() / kOutlierSamples + 1)
    found.away = std::max(found.away, surface.nearest(vertices[i]).lower);
  return found;
}

}  // namespace kaboum::certify
