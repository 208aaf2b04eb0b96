// Containers of a robot's links: placed bodies, serialised, read back, decided.

#include <kaboum/base/error.h>
#include <kaboum/certify/robot.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <array>
#include <optional>

#include "issuer.h"
#include "link_cache.h"
#include "link_polytopes.h"

namespace kaboum::certify {
namespace {

/// Allowances for rounding, tried one after the other.
constexpr std::array<double, 3> kAllowance{1, 16, 256};

/// What its container says of a link's set; the distance apart.
geom::Provenance origin_of(const robot::RobotFile& robot, const RobotRequest& request,
                           std::uint32_t link) {
  geom::Provenance p;
  p.source = robot.path.filename().string();
  p.source_sha256 = robot.sha256;
  p.tool = request.tool.empty() ? "bcd-decompose " KABOUM_VERSION : request.tool;
  p.parameters = request.parameters(robot.robot.links[link].name);
  p.unit = request.set.unit;
  p.frame = robot.robot.links[link].name;
  p.direction = "outer";
  p.covers_solid = p.covers_surface = true;
  return p;
}

/// @param claims  of the set, its distance apart.
CertifiedLink certify_link(const std::vector<robot::LinkBody>& bodies,
                           const LinkCertificate& certificate, const geom::Provenance& claims) {
  std::string wrong;
  for (const double allowance : kAllowance) {
    auto [made, beyond] = link_polytopes(bodies, allowance);
    made.provenance = claims;
    made.provenance.epsilon = certificate.distance + beyond;
    std::vector<char> container = io::serialise_convex_set(made, io::SetFormat::Glb);
    // What is written is what is decided.
    geom::ConvexSet set = io::parse_convex_set(container, io::Format::Glb, "the result");
    wrong = objection(set, bodies);
    if (wrong.empty()) return Issuer::issue(std::move(set), certificate, std::move(container));
  }
  throw Error(ErrorCode::Internal, "link '" + claims.frame +
                                       "': no polytopes were found that pass the exact check (" +
                                       wrong + "); nothing is written");
}

/// A link that has shapes, and what its set is to claim.
struct LinkRecord {
  LinkCertificate certificate;
  geom::Provenance claims;
};

}  // namespace

CertifiedRobot certify_robot(const robot::RobotFile& robot, const RobotRequest& request,
                             const SetCache* cache, const RobotHooks& hooks) {
  if (request.set.body_kind != SetRequest::BodyKind::Polytopes)
    throw Error(ErrorCode::InvalidArgument,
                "a robot's containers hold polytopes; its spheres are those of certify_bodies");
  CertifiedRobot out{certify_bodies(robot, request, cache, hooks), {}};
  const BodiesCertificate& made = out.bodies.certificate();
  std::vector<LinkRecord> links;
  for (const robot::LinkShape& shape : made.shapes) {
    if (links.empty() || links.back().certificate.link != shape.link)
      links.push_back({{shape.link, 0, 0}, origin_of(robot, request, shape.link)});
    auto& [link, p] = links.back();
    ++link.shapes;
    if (shape.mesh && !made.meshes[*shape.mesh].held) {
      ++link.kept;
      continue;
    }
    link.distance = std::max(link.distance, distance_of(robot, made, shape));
    if (!shape.mesh) continue;
    const geom::Provenance& claims = made.meshes[*shape.mesh].made.found.set.artefact().provenance;
    p.covers_solid = p.covers_solid && claims.covers_solid;
    p.covers_surface = p.covers_surface && claims.covers_surface;
  }
  std::optional<CacheFolder> folder;
  if (cache != nullptr) folder.emplace(cache->folder());
  for (const auto& [link, claims] : links) {
    if (link.kept > 0) continue;  // a set without a shape of it would be no set of the link
    std::vector<robot::LinkBody> bodies;
    for (const robot::LinkBody& body : out.bodies.artefact())
      if (body.link == link.link) bodies.push_back(body);
    const LinkCache known(folder ? &*folder : nullptr, {bodies, link, claims});
    std::string flaw;
    std::optional<CertifiedLink> set = known.find(flaw);
    if (hooks.note && !flaw.empty())
      hooks.note(robot.path.string(), "the cache's entry " + flaw + "; it is made again");
    if (!set) {
      set = certify_link(bodies, link, claims);
      known.store(*set);
    }
    out.links.push_back(*std::move(set));
  }
  return out;
}

}  // namespace kaboum::certify
