// Containers of a robot's links: placed bodies, serialised, read back, decided.

#include <kaboum/base/error.h>
#include <kaboum/certify/robot.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <array>

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
  p.parameters = request.parameters();
  p.unit = request.set.unit;
  p.frame = robot.robot.links[link].name;
  p.direction = "outer";
  p.covers_solid = p.covers_surface = true;
  return p;
}

/// @param out  gets set and container; the set has its claims, apart from the distance.
void certify_link(const std::vector<robot::LinkBody>& bodies, CertifiedLink& out) {
  const geom::Provenance claims = out.set.provenance;
  std::string wrong;
  for (const double allowance : kAllowance) {
    auto [made, beyond] = link_polytopes(bodies, allowance);
    made.provenance = claims;
    made.provenance.epsilon = out.distance + beyond;
    out.container = io::serialise_convex_set(made, io::SetFormat::Glb);
    // What is written is what is decided.
    out.set = io::parse_convex_set(out.container, io::Format::Glb, "the result");
    wrong = objection(out.set, bodies);
    if (wrong.empty()) return;
  }
  throw Error(ErrorCode::Internal, "link '" + claims.frame +
                                       "': no polytopes were found that pass the exact check (" +
                                       wrong + "); nothing is written");
}

}  // namespace

CertifiedRobot certify_robot(const robot::RobotFile& robot, const RobotRequest& request,
                             const SetCache* cache, const RobotHooks& hooks) {
  CertifiedRobot out{certify_bodies(robot, request, cache, hooks), {}};
  for (const robot::LinkShape& shape : out.bodies.shapes) {
    if (out.links.empty() || out.links.back().link != shape.link) {
      out.links.emplace_back().link = shape.link;
      out.links.back().set.provenance = origin_of(robot, request, shape.link);
    }
    CertifiedLink& link = out.links.back();
    ++link.shapes;
    link.distance = std::max(link.distance, distance_of(robot, out.bodies, shape));
    if (!shape.mesh) continue;
    const geom::Provenance& claims = out.bodies.meshes[*shape.mesh].made.found.set.set.provenance;
    geom::Provenance& p = link.set.provenance;
    p.covers_solid = p.covers_solid && claims.covers_solid;
    p.covers_surface = p.covers_surface && claims.covers_surface;
  }
  for (CertifiedLink& link : out.links) {
    std::vector<robot::LinkBody> bodies;
    for (const robot::LinkBody& body : out.bodies.bodies)
      if (body.link == link.link) bodies.push_back(body);
    certify_link(bodies, link);
  }
  return out;
}

}  // namespace kaboum::certify
