// Contacts and motions in words and as JSON.

#include "check_report.h"

#include <array>
#include <cstdint>
#include <optional>
#include <sstream>

namespace kaboum::tools {
namespace {

Json to_json(const geom::Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// The number of the point of a cloud that is in contact, if one is.
std::optional<std::uint32_t> point_of(const world::World& world, const world::Contact& contact) {
  if (contact.substituted) return std::nullopt;
  const auto first = world.point_of(contact.items[0], contact.bodies.a);
  return first ? first : world.point_of(contact.items[1], contact.bodies.b);
}

const char* answer_of(const world::Contact& contact) {
  return contact.certain ? "colliding" : "within epsilon";
}

}  // namespace

std::string describe(const world::World& world, const world::Contact& contact) {
  std::ostringstream out;
  out.precision(4);
  out << world.name_of(contact.items[0]) << " and " << world.name_of(contact.items[1]);
  if (const auto point = point_of(world, contact)) out << " (point " << *point << ")";
  if (contact.certain)
    out << " collide";
  else if (contact.margin > 0)
    out << " are within the margin of " << contact.margin << ": no farther apart than "
        << contact.epsilon;
  else
    out << " are within epsilon: no farther apart than " << contact.epsilon;
  if (contact.depth) {
    const auto& [lower, upper, direction] = *contact.depth;
    // Outer sets reach beyond their solids: only without epsilon is it the solids' depth.
    out << (contact.certain && contact.epsilon == 0 ? ", " : "; their sets are ");
    // As many digits as both ends share.
    if (upper - lower <= 1e-3 * upper)
      out << upper << " deep";
    else
      out << lower << " to " << upper << " deep";
  }
  out << ", at [" << contact.place.x() << ", " << contact.place.y() << ", " << contact.place.z()
      << "]";
  return out.str();
}

Json to_json(const world::World& world, const world::Contact& contact) {
  Json out = {{"answer", answer_of(contact)},
              {"pair", {world.name_of(contact.items[0]), world.name_of(contact.items[1])}},
              {"bodies", {contact.bodies.a, contact.bodies.b}},
              {"epsilon", contact.epsilon},
              {"margin", contact.margin},
              {"place", to_json(contact.place)}};
  if (const auto point = point_of(world, contact)) out["point"] = *point;
  if (contact.depth)
    out["depth"] = {{"lower", contact.depth->lower},
                    {"upper", contact.depth->upper},
                    {"direction", to_json(contact.depth->direction)}};
  return out;
}

std::string describe(const world::World& world, const world::MotionAnswer& answer) {
  std::ostringstream out;
  out.precision(6);
  if (answer.outcome == world::MotionAnswer::Outcome::Free) return "free at every instant";
  // Waypoints are counted from 1, as in all that is said of paths.
  const auto place = [&](std::size_t segment, double share) {
    out << "waypoint " << segment + 1;
    if (share > 0) out << " + " << share << " of the way to the next";
  };
  const bool undecided = answer.outcome == world::MotionAnswer::Outcome::Undecided;
  out << (undecided ? "undecided: " : "");
  if (answer.segment == 0 && answer.share == 0) {
    out << (undecided ? "nothing is known from the first waypoint on"
                      : "not free from the first waypoint on");
  } else {
    out << "free until ";
    place(answer.segment, answer.share);
  }
  if (!answer.contact) return out.str();
  out << "; at ";
  place(answer.contact_segment, answer.contact_share);
  out << ", " << (answer.meets ? "" : "nearly: ") << describe(world, *answer.contact);
  return out.str();
}

Json to_json(const world::World& world, const world::MotionAnswer& answer) {
  constexpr std::array<const char*, 3> kOutcomes{"free", "contact", "undecided"};
  Json out = {{"outcome", kOutcomes.at(static_cast<std::size_t>(answer.outcome))},
              {"intervals", answer.intervals},
              {"queries", answer.queries}};
  if (answer.outcome == world::MotionAnswer::Outcome::Free) return out;
  out["free_until"] = {{"waypoint", answer.segment + 1}, {"share", answer.share}};
  if (!answer.contact) return out;
  out["contact"] = to_json(world, *answer.contact);
  out["contact"]["waypoint"] = answer.contact_segment + 1;
  out["contact"]["share"] = answer.contact_share;
  out["contact"]["sets_meet"] = answer.meets;
  return out;
}

Json to_json(const robot::Robot& robot, const motion::PathConstraint& c) {
  Json out = {
      {"name", c.name}, {"relation", name_of(c.relation)}, {"link", robot.links[c.link].name}};
  const bool has_value =
      c.relation == kinematics::Relation::Distance || c.relation == kinematics::Relation::Angle;
  if (has_value) out["value"] = c.value;
  const kinematics::Measures measures = measures_of(kinematics_constraint(c));
  if (measures.length) out["within"] = c.within;
  if (measures.angle) out["within_angle"] = c.within_angle;
  return out;
}

}  // namespace kaboum::tools
