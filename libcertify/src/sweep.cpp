// Swept sets: searched for, serialised, read back, decided. There is no other search to try: where
// the decision refutes what the steps' proof says, one of the two is wrong.

#include <kaboum/base/error.h>
#include <kaboum/certify/sweep.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include "issuer.h"
#include "swept_motion.h"

namespace kaboum::certify {
namespace {

SweepCertificate sweep_certificate(const sweep::SweepResult& made, const CertifiedBodies& bodies,
                                   const geom::ConvexSet& set) {
  SweepCertificate c;
  c.motion = made.certified ? MotionClaim::Proved : MotionClaim::None;
  c.bodies = set.bodies.size();
  for (const geom::ConvexBody& body : set.bodies) c.vertices += body.core.vertices.size();
  c.margin = geom::margin_of(set).value();
  c.deviation = made.deviation;
  c.left_out = made.left_out;
  c.rounding = made.rounding;
  c.excess = made.excess;
  c.bodies_distance = bodies.certificate().distance;
  c.of_link = made.of_link;
  c.sources = made.sources;
  return c;
}

void decide(const geom::ConvexSet& set, SweepCertificate& certificate,
            const robot::RobotFile& robot, const CertifiedBodies& bodies, const robot::Path& path,
            const SweepRequest& request) {
  const verify::Claim convex = verify::verify_convexity(set).convex;
  ensure(convex.answer == verify::Answer::Verified, "a body of the swept volume is not convex");
  if (!request.decide_motion || certificate.motion == MotionClaim::None) return;
  const verify::Claim held =
      decide_motion(robot, bodies, path, set, request.max_cells, request.search.progress);
  if (held.answer == verify::Answer::Refuted)
    throw Error(ErrorCode::Internal, "the swept volume does not pass the exact check (" +
                                         held.reason + "); nothing is written");
  if (held.answer == verify::Answer::Verified)
    certificate.motion = MotionClaim::Decided;
  else
    certificate.undecided = held.reason;
}

}  // namespace

std::optional<CertifiedSweep> certify_sweep(const robot::RobotFile& robot,
                                            const CertifiedBodies& bodies, const robot::Path& path,
                                            const SweepRequest& request) {
  sweep::SweepResult made =
      sweep::swept_volume(robot.robot, bodies.artefact(), path, request.search);
  if (made.stop == sweep::Stop::TooCoarse) return std::nullopt;
  geom::Provenance& p = made.set.provenance;
  p.source = robot.path.filename().string();
  p.source_sha256 = robot.sha256;
  p.tool = "sweep-approx " KABOUM_VERSION;
  p.parameters = request.parameters;
  p.unit = request.unit;
  p.frame = robot.robot.links[0].name;
  if (made.certified) {
    p.direction = "outer";
    p.epsilon = (made.excess + bodies.certificate().distance) * (1 + 1e-15);
  }
  std::vector<char> container = io::serialise_convex_set(made.set, io::SetFormat::Glb);
  // What is written is what is decided.
  geom::ConvexSet set = io::parse_convex_set(container, io::Format::Glb, "the result");
  ensure(geom::margin_of(set) == geom::margin_of(made.set), "the margin does not survive writing");
  ensure(set.bodies.size() == made.set.bodies.size(), "a body does not survive writing");
  SweepCertificate certificate = sweep_certificate(made, bodies, set);
  decide(set, certificate, robot, bodies, path, request);
  return Issuer::issue(std::move(set), std::move(certificate), std::move(container));
}

}  // namespace kaboum::certify
