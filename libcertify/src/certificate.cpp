// Certificates of all artefacts in one shape, and as JSON.

#include <kaboum/certify/certificate.h>
#include <kaboum/certify/enclosure.h>
#include <kaboum/certify/inner_links.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/sweep.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "claim_record.h"

namespace kaboum::certify {
namespace {

using Json = nlohmann::ordered_json;
using Kind = Claim::Kind;
using verify::Answer;

Claim verified(Kind kind, Basis basis = Basis::Bytes) {
  return {.kind = kind, .basis = basis, .answer = Answer::Verified};
}

Claim distance_claim(Kind kind, double bound) {
  return {.kind = kind, .basis = Basis::Measured, .answer = Answer::Verified, .distance = bound};
}

}  // namespace

const char* name_of(Basis basis) {
  switch (basis) {
    case Basis::Bytes:
      return "decided from the bytes";
    case Basis::Meshes:
      return "decided from the meshes";
    case Basis::Steps:
      return "by exact tests of every step";
    case Basis::Measured:
      break;
  }
  return "measured";
}

const char* name_of(Claim::Kind kind) {
  switch (kind) {
    case Kind::Solid:
      return "solid";
    case Kind::Winding:
      return "winding number";
    case Kind::Surface:
      return "surface";
    case Kind::Nested:
      return "nested";
    case Kind::OriginalToResult:
      return "distance from original to result";
    case Kind::ResultToOriginal:
      return "distance from result to original";
    case Kind::Convex:
      return "convex bodies";
    case Kind::Motion:
      return "motion";
    case Kind::Depth:
      break;
  }
  return "depth of what is left out";
}

Json record_of(const Claim& claim) {
  Json j{{"claim", name_of(claim.kind)},
         {"basis", name_of(claim.basis)},
         {"answer", name_of(claim.answer)}};
  if (!claim.reason.empty()) j["reason"] = claim.reason;
  if (claim.distance) j["distance"] = *claim.distance;
  return j;
}

bool Certificate::holds() const {
  bool any = false;
  for (const Claim& claim : claims) {
    if (claim.answer == Answer::Refuted || claim.answer == Answer::Undecided) return false;
    any = any || claim.answer == Answer::Verified;
  }
  return any;
}

std::string to_json(const Certificate& certificate) {
  Json j;
  constexpr std::array<const char*, 3> kDirections{"outer", "inner", "any"};
  j["direction"] = kDirections.at(static_cast<std::size_t>(certificate.direction));
  j["of"] = certificate.subject;
  j["claims"] = Json::array();
  for (const Claim& claim : certificate.claims) j["claims"].push_back(record_of(claim));
  j["distance"] = certificate.distance ? Json{{"lower", certificate.distance->lower},
                                              {"upper", certificate.distance->upper}}
                                       : Json();
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Certificate certificate_of(const CertifiedSet& set) {
  const SetCertificate& c = set.certificate();
  Certificate out;
  out.subject = in_words(c.subject);
  out.distance = {c.distance_lower, c.distance_upper};
  out.claims.push_back(verified(Kind::Convex));
  Claim solid = verified(Kind::Solid);
  if (c.direction == SetRequest::Direction::Inner) {
    out.direction = Certificate::Direction::Inner;
    out.claims.push_back(std::move(solid));
    out.claims.push_back(distance_claim(Kind::Depth, c.distance_upper));
    if (c.depth_decided) out.claims.back().basis = Basis::Bytes;
    return out;
  }
  if (!c.undecided.empty()) {
    solid.answer = Answer::Undecided;
    solid.reason = c.undecided;
  }
  out.claims.push_back(std::move(solid));
  out.claims.push_back(verified(Kind::Surface));
  out.claims.push_back(distance_claim(Kind::ResultToOriginal, c.distance_upper));
  return out;
}

Certificate certificate_of(const CertifiedEnclosure& enclosure) {
  const EnclosureCertificate& c = enclosure.certificate();
  Certificate out;
  out.subject = in_words(c.subject);
  out.distance = {0, c.distance_upper};
  for (const Claim& claim : c.claims)
    if (claim.kind != Kind::Surface) out.claims.push_back(claim);
  out.claims.push_back({.kind = Kind::Surface,
                        .basis = Basis::Bytes,
                        .answer = c.inside.answer,
                        .reason = c.inside.reason});
  return out;
}

Certificate certificate_of(const CertifiedWrap& wrap) {
  const WrapCertificate& c = wrap.certificate();
  Certificate out;
  out.subject = "all triangles of the input";
  out.distance = {c.farthest_lower, c.farthest_upper};
  out.claims = {verified(Kind::Surface), distance_claim(Kind::ResultToOriginal, c.farthest_upper)};
  return out;
}

Certificate certificate_of(const CertifiedSweep& sweep) {
  const SweepCertificate& c = sweep.certificate();
  Certificate out;
  out.subject = c.margin > 0
                    ? "what the robot's links sweep along the path, by the bodies with their margin"
                    : "what the robot's links sweep along the path";
  out.claims.push_back(verified(Kind::Convex));
  Claim motion =
      verified(Kind::Motion, c.motion == MotionClaim::Decided ? Basis::Bytes : Basis::Steps);
  if (c.motion == MotionClaim::None) {
    motion.answer = Answer::Undecided;
    motion.reason = "the rule of steps has no proof";
  }
  out.claims.push_back(std::move(motion));
  if (c.motion == MotionClaim::None) return out;                           // nor for the distance
  const double distance = (c.excess + c.bodies_distance) * (1 + 0x1p-50);  // rounded up
  out.distance = {0, distance};
  out.claims.push_back(distance_claim(Kind::ResultToOriginal, distance));
  return out;
}

Certificate certificate_of(const CertifiedLink& link) {
  const double distance = link.certificate().distance;
  Certificate out;
  out.subject = "the link's shapes";
  out.distance = {0, distance};
  out.claims = {verified(Kind::Convex), verified(Kind::Solid),
                distance_claim(Kind::ResultToOriginal, distance)};
  return out;
}

Certificate certificate_of(const CertifiedInnerLink& link) {
  const double depth = link.certificate().depth;
  Certificate out;
  out.direction = Certificate::Direction::Inner;
  out.subject = "the link's shapes";
  out.distance = {0, depth};
  out.claims = {verified(Kind::Convex), verified(Kind::Solid), distance_claim(Kind::Depth, depth)};
  return out;
}

}  // namespace kaboum::certify
