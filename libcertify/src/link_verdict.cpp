// The verdict on each link, from the certificates of its meshes.

#include <kaboum/base/number_text.h>
#include <kaboum/certify/link_verdict.h>

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

namespace kaboum::certify {
namespace {

using verify::Answer;

/// What came of a mesh, and why it is no better.
struct MeshOutcome {
  Outcome outcome = Outcome::Held;
  std::string why;
  std::size_t dropped_sheets = 0;
};

MeshOutcome outcome_of(const CertifiedLinkMesh& mesh) {
  if (!mesh.mesh.missing.empty()) return {Outcome::Missing, mesh.flaw, 0};
  if (!mesh.held) return {Outcome::Kept, mesh.flaw, 0};
  const SetCertificate& c = mesh.made.found.set.certificate();
  MeshOutcome out{Outcome::Held, {}, c.subject.dropped_sheets};
  if (!mesh.flaw.empty()) {
    out.outcome = Outcome::Far;
    out.why = mesh.flaw;
  } else if (!c.undecided.empty()) {
    out.outcome = Outcome::Undecided;
    out.why = mesh.mesh.file.string() + ": " + c.undecided;
  } else if (c.stop == bcd::Stop::OutOfWork) {
    out.outcome = Outcome::Late;
  } else if (!c.reached()) {
    out.outcome = Outcome::Far;
  }
  return out;
}

MeshOutcome outcome_of(const EnclosedLinkMesh& mesh) {
  if (!mesh.mesh.missing.empty()) return {Outcome::Missing, mesh.flaw, 0};
  if (!mesh.flaw.empty()) return {Outcome::Kept, mesh.flaw, 0};
  const EnclosureCertificate& c = mesh.made.enclosure.certificate();
  MeshOutcome out{Outcome::Held, {}, c.subject.dropped_sheets};
  const std::string file = mesh.mesh.file.string();
  if (c.inside.answer == Answer::Refuted) {
    out.outcome = Outcome::Outside;
    out.why =
        file + ": " + std::to_string(c.inside.outside) +
        (c.inside.outside == 1 ? " triangle sticks" : " triangles stick") + " out" +
        (c.inside.farther ? ", by up to " + number_up(*c.inside.farther) + " in the mesh's own unit"
                          : std::string());
  } else if (c.inside.answer != Answer::Verified) {
    out.outcome = Outcome::Undecided;
    out.why = file + ": " + c.inside.reason;
  } else if (c.stop == bmesh::Stop::OutOfWork) {
    out.outcome = Outcome::Late;
  } else if (!c.reached) {
    out.outcome = Outcome::Far;
  }
  return out;
}

/// @param held  what is said of a link that is held
std::string sentence_of(const MeshOutcome& worst, const std::string& held, std::size_t sheets) {
  std::string but = sheets == 0 ? held
                                : "every triangle is inside but the " + std::to_string(sheets) +
                                      " of sheets that were dropped on request";
  const std::string why = worst.why.empty() ? std::string() : ": " + worst.why;
  switch (worst.outcome) {
    case Outcome::Held:
      return but;
    case Outcome::Late:
      return but + "; the work allowed ended before what was asked for was reached";
    case Outcome::Far:
      return but + ", but not as near or with as few vertices and bodies as asked for" + why;
    case Outcome::Undecided:
      return "whether every triangle is inside is NOT decided" + why;
    case Outcome::Outside:
      return "NOT every triangle is inside" + why;
    case Outcome::Kept:
      return "NOT enclosed, its mesh stays as it was" + why;
    case Outcome::Missing:
      break;
  }
  return "NOT verified, its mesh is missing and left out" + why;
}

/// @param others  what is said of a link without meshes
template <class Mesh>
std::vector<LinkVerdict> verdicts_of(const std::vector<robot::LinkShape>& shapes,
                                     const std::vector<Mesh>& meshes,
                                     const std::function<std::string(std::uint32_t link)>& others) {
  std::vector<LinkVerdict> out;
  std::vector<MeshOutcome> worst;
  std::vector<char> has_mesh;
  for (const robot::LinkShape& shape : shapes) {
    if (out.empty() || out.back().link != shape.link) {
      out.push_back({shape.link, 0, Outcome::Held, {}, 0});
      worst.emplace_back();
      has_mesh.push_back(0);
    }
    ++out.back().shapes;
    if (!shape.mesh) continue;
    has_mesh.back() = 1;
    MeshOutcome found = outcome_of(meshes[*shape.mesh]);
    out.back().dropped_sheets += found.dropped_sheets;
    if (found.outcome > worst.back().outcome) worst.back() = std::move(found);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].outcome = worst[i].outcome;
    out[i].sentence =
        sentence_of(worst[i], has_mesh[i] != 0 ? "every triangle is inside" : others(out[i].link),
                    out[i].dropped_sheets);
  }
  return out;
}

}  // namespace

const char* name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::Held:
      return "held";
    case Outcome::Late:
      return "work ended";
    case Outcome::Far:
      return "epsilon not reached";
    case Outcome::Undecided:
      return "undecided";
    case Outcome::Outside:
      return "not held";
    case Outcome::Kept:
      return "kept";
    case Outcome::Missing:
      break;
  }
  return "missing";
}

std::vector<LinkVerdict> verdicts(const CertifiedBodies& robot) {
  const BodiesCertificate& bodies = robot.certificate();
  return verdicts_of(bodies.shapes, bodies.meshes, [&](std::uint32_t link) {
    const bool has_body = std::ranges::any_of(
        robot.artefact(), [&](const robot::LinkBody& body) { return body.link == link; });
    return std::string(has_body ? "its shapes are inside"
                                : "its shapes are points, which no body covers");
  });
}

std::vector<LinkVerdict> verdicts(const CertifiedRobot& robot) { return verdicts(robot.bodies); }

std::vector<LinkVerdict> verdicts(const LinkEnclosures& robot) {
  return verdicts_of(robot.shapes, robot.meshes,
                     [](std::uint32_t) { return std::string("its shapes stay as they are"); });
}

namespace {

/// Adds what a link's shapes have of a region.
/// @param looked_at  meshes so far
void look_at(const robot::RobotFile& robot, std::uint32_t link, const robot::LinkRegion& region,
             const CertifiedBodies& bodies, std::size_t& looked_at, RegionVerdict& out) {
  const BodiesCertificate& made = bodies.certificate();
  for (const robot::LinkBody& body : bodies.artefact())
    out.reached =
        out.reached || (body.link == link && !(geom::distance_from(region.region, body.points) >
                                               body.margin + region.rounding));
  if (!region.epsilon.percent) out.epsilon = std::max(out.epsilon, region.epsilon.value);
  for (const robot::LinkShape& shape : made.shapes) {
    if (shape.link != link || !shape.mesh) continue;
    const CertifiedLinkMesh& mesh = made.meshes[*shape.mesh];
    const auto of_mesh = [&]() -> const SetCertificate::Region* {
      if (!mesh.held || !mesh.flaw.empty()) return nullptr;
      const auto& all = mesh.made.found.set.certificate().regions;
      const auto at = std::ranges::find(all, region.name, &SetCertificate::Region::name);
      return at == all.end() ? nullptr : &*at;
    };
    const SetCertificate::Region* found = of_mesh();
    out.held = out.held && found != nullptr;
    if (found != nullptr) {
      const double diagonal = mesh.made.found.set.certificate().diagonal;
      const bool is_idle = mesh.epsilon && mesh.epsilon->of(diagonal) <= found->epsilon;
      out.is_idle = is_idle && (out.is_idle || looked_at == 0);
      ++looked_at;
    }
    if (found == nullptr || !region.epsilon.percent) continue;
    const robot::Geometry& g = made.choice.shapes_of(robot.robot.links[link])[shape.index];
    out.epsilon = std::max(out.epsilon, found->epsilon * g.size.cwiseAbs().maxCoeff());
  }
}

}  // namespace

std::vector<RegionVerdict> region_verdicts(const robot::RobotFile& robot,
                                           const robot::LinkRegions& regions,
                                           const CertifiedBodies& bodies) {
  std::vector<RegionVerdict> out;
  std::map<std::string, std::size_t> looked_at;
  for (std::uint32_t link = 0; link < robot.robot.links.size(); ++link) {
    const std::string& name = robot.robot.links[link].name;
    const auto own = regions.find(name);
    if (own == regions.end()) continue;
    for (const robot::LinkRegion& region : own->second) {
      auto at = std::ranges::find(out, region.name, &RegionVerdict::name);
      if (at == out.end()) at = out.insert(at, {region.name, {}});
      at->links.push_back(name);
      look_at(robot, link, region, bodies, looked_at[region.name], *at);
    }
  }
  return out;
}

std::string in_words(const RegionVerdict& region) {
  if (!region.held)
    return "distance in the region " + region.name +
           ": NOT verified: a mesh near it is not held as asked for";
  if (!region.reached) return "note: no body reaches the region " + region.name;
  return "distance in the region " + region.name + ": verified: nowhere more than " +
         number_up(region.epsilon) +
         (region.is_idle ? "; no less than outside of it, so that it changes nothing" : "");
}

Outcome outcome_of(const std::vector<LinkVerdict>& links) {
  Outcome out = Outcome::Held;
  for (const LinkVerdict& link : links) out = std::max(out, link.outcome);
  return out;
}

std::string in_words(const std::vector<LinkVerdict>& links) {
  std::size_t outside = 0, sheets = 0;
  bool reached = true;
  for (const LinkVerdict& link : links) {
    outside += link.outcome >= Outcome::Undecided ? 1 : 0;
    reached = reached && (link.outcome == Outcome::Held || link.outcome >= Outcome::Undecided);
    sheets += link.dropped_sheets;
  }
  const std::string all = links.size() == 1 ? "1 link" : std::to_string(links.size()) + " links";
  std::string out = outside > 0
                        ? "NOT every triangle is known to be inside: " + std::to_string(outside) +
                              " of " + all + (outside == 1 ? " is" : " are") + " not held"
                        : "every triangle of " + all + " is inside";
  if (sheets > 0)
    out += " but the " + std::to_string(sheets) + " of sheets that were dropped on request";
  return out + (reached ? "" : "; not all that was asked for was reached");
}

}  // namespace kaboum::certify
