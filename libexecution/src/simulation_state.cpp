// Geometric states of a plan as a simulation has them.

#include "simulation_state.h"

#include <kaboum/base/error.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/grasp_family.h>
#include <kaboum/world/gripper.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "motion_part.h"

namespace kaboum::execution {
namespace {

/// Ten times what words of poses are rounded to. [length, 1]
constexpr double kSame = 1e-6;
/// How far a plane may be from upright that is pushed: objects count as level up to this. [1]
constexpr double kUpright = 1e-4;
/// How far what is pushed may be off its line [length], and leaning or turned [rad].
constexpr double kOffLine = 1e-3, kOffTurn = 5e-3;

/// The value of FUNCTION(NAME); `otherwise` where the domain does not have the term.
std::optional<std::string> word(const plan::Model& model, const plan::KnownState& known,
                                const char* function, const std::string& name,
                                std::string_view otherwise) {
  const auto has = [&](const auto& list, const std::string& wanted) {
    return std::ranges::any_of(list, [&](const auto& x) { return x.name == wanted; });
  };
  if (!has(model.functions, function) || !has(model.objects, name)) return std::string(otherwise);
  const auto symbol = std::ranges::find(model.functions, function, &plan::Symbol::name);
  const auto object = std::ranges::find(model.objects, name, &plan::Object::name);
  if (symbol->parameters.size() != 1 ||
      !model.is_a(static_cast<plan::Index>(object - model.objects.begin()), symbol->parameters[0]))
    return std::string(otherwise);
  return known.value(function, {name});
}

/// How far a point is from a surface that is raised along its normal: by the corners of its outline
/// in coordinates of its plane.
double off_surface(const world::Feature& surface, const geom::Transform& pose,
                   const geom::Vec3& point, double raised) {
  const geom::Vec3 normal = pose.linear * surface.direction;
  const geom::Vec3 off = point - pose * surface.point;
  const double above = off.dot(normal) - raised;
  const geom::Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  if (surface.outline.empty())
    return std::hypot(above, std::max(0.0, std::hypot(off.dot(x), off.dot(y)) - surface.radius));
  std::vector<Eigen::Vector2d> corners;
  corners.reserve(surface.outline.size());
  for (const geom::Vec3& corner : surface.outline) {
    const geom::Vec3 c = pose.linear * (corner - surface.point);
    corners.emplace_back(c.dot(x), c.dot(y));
  }
  const Eigen::Vector2d p(off.dot(x), off.dot(y));
  bool inside = true;
  double beside = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d from = corners[i], along = corners[(i + 1) % corners.size()] - from,
                          to = p - from;
    inside = inside && along.x() * to.y() - along.y() * to.x() >= 0;
    const double share = std::clamp(along.dot(to) / along.squaredNorm(), 0.0, 1.0);
    beside = std::min(beside, (to - share * along).norm());
  }
  return std::hypot(above, inside ? 0.0 : beside);
}

world::ToleratedConstraint swapped(world::ToleratedConstraint c) {
  std::swap(c.first, c.second);
  return c;
}

/// Whether a constraint is met, by formulas of its own. Tolerances are of the first feature's
/// point, or of the point where one feature is none.
/// @param a, b  poses of what the features are fixed to
bool meets(const world::ToleratedConstraint& c, const geom::Transform& a,
           const geom::Transform& b) {
  using Kind = world::Feature::Kind;
  using kinematics::Relation;
  const Kind first = c.first.feature.kind, second = c.second.feature.kind;
  const geom::Vec3 apart = a * c.first.feature.point - b * c.second.feature.point,
                   u = a.linear * c.first.feature.direction,
                   v = b.linear * c.second.feature.direction;
  // Distance of the first one's point from the second, or of the point from what is none.
  const auto from = [&](Kind kind, const geom::Vec3& direction) {
    return kind == Kind::Point  ? apart.norm()
           : kind == Kind::Line ? apart.cross(direction).norm()
                                : std::abs(apart.dot(direction));
  };
  if (first == Kind::Surface || second == Kind::Surface) {
    const bool surface_first = first == Kind::Surface;
    const world::Feature& surface = surface_first ? c.first.feature : c.second.feature;
    if (c.relation == Relation::Coincident || c.relation == Relation::Distance)
      return off_surface(surface, surface_first ? a : b,
                         surface_first ? b * c.second.feature.point : a * c.first.feature.point,
                         c.value) <= c.within + kSame;
  }
  const double distance = second == Kind::Point ? from(first, u) : from(second, v);
  const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
  const bool mixed = (first == Kind::Line) != (second == Kind::Line);  // a line and what is flat
  switch (c.relation) {
    case Relation::Distance:
      return std::abs(distance - c.value) <= c.within + kSame;
    case Relation::Coincident: {
      if (distance > c.within + kSame) return false;
      if (first == Kind::Point || second == Kind::Point) return true;
      const double off = std::min(angle, std::numbers::pi - angle);
      return (mixed ? std::numbers::pi / 2 - off : off) <= c.within_angle + kSame;
    }
    case Relation::Parallel:
    case Relation::Perpendicular: {
      const double off = std::min(angle, std::numbers::pi - angle);
      const bool along = (c.relation == Relation::Parallel) != mixed;
      return (along ? off : std::numbers::pi / 2 - off) <= c.within_angle + kSame;
    }
    case Relation::Angle:
      // From a plane to a line: towards its normal.
      return std::abs((mixed ? std::numbers::pi / 2 - angle : angle) - c.value) <=
             c.within_angle + kSame;
  }
  return false;
}

}  // namespace

std::optional<StatedState> state_of(const world::World& world, const plan::Model& model,
                                    const plan::KnownState& known) {
  StatedState out;
  for (const world::RobotModel& robot : world.robots) {
    const auto conf = word(model, known, "conf", robot.name, manipulation::kHome);
    if (!conf) return std::nullopt;
    out.state.q.push_back(manipulation::configuration_of(*conf, robot));
    out.words += *conf + "\n";
  }
  std::vector<geom::Transform> relative(world.objects.size());
  out.held.resize(world.objects.size());
  out.mounted.resize(world.objects.size());
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    const auto pose = word(model, known, "pose", world.objects[o].name, manipulation::kStart);
    if (!pose) return std::nullopt;
    const manipulation::ObjectPlace place = manipulation::place_of(*pose, world, o);
    judge::CellState::Place put{place.pose, std::nullopt, place.absent};
    if (const auto& a = place.attachment) put.hold = judged(*a);
    out.held[o] = place.attachment;
    out.mounted[o] = place.mounted_on;
    relative[o] = place.pose;
    out.state.objects.push_back(std::move(put));
    out.words += *pose + "\n";
  }
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    set_grippers(world, r, out.held, out.state.q[r]);
  // What is mounted is where the object below it is, and moves with it.
  std::vector<char> resolved(world.objects.size(), 0);
  const std::function<void(std::size_t, std::size_t)> resolve = [&](std::size_t o,
                                                                    std::size_t depth) {
    const auto below = out.mounted[o];
    if (!below || resolved[o] != 0) return;
    if (depth > world.objects.size())
      throw Error(ErrorCode::InvalidInput, "objects are mounted on each other in a circle");
    resolve(*below, depth + 1);
    judge::CellState::Place place = out.state.objects[*below];
    geom::Transform& pose = place.hold ? place.hold->pose : place.pose;
    pose = judge::product(pose, relative[o]);
    if (place.hold && !place.hold->link_touches) place.hold->touching.clear();  // pads do not
    out.state.objects[o] = std::move(place);
    resolved[o] = 1;
  };
  for (std::size_t o = 0; o < world.objects.size(); ++o) resolve(o, 0);
  return out;
}

geom::Transform inverse(const geom::Transform& pose) {
  return {pose.linear.transpose(), -(pose.linear.transpose() * pose.translation)};
}

bool same(const geom::Transform& a, const geom::Transform& b) {
  return (a.translation - b.translation).norm() <= kSame &&
         (a.linear - b.linear).cwiseAbs().maxCoeff() <= kSame;
}

bool is_at_grasp(const world::World& world, std::size_t robot, std::uint32_t link,
                 const geom::Transform& link_pose, std::size_t object,
                 const geom::Transform& object_pose) {
  for (const world::ToolFrame& tool : world.robots[robot].tools)
    for (const world::Grasp& grasp : world.objects[object].grasps)
      if (tool.link == link) {
        const geom::Transform at = judge::product(link_pose, tool.pose);
        if (!grasp.constraints.empty()) {
          const auto is_met = [&](const world::ToleratedConstraint& c) {
            return meets(c, at, object_pose) || meets(swapped(c), object_pose, at);
          };
          if (std::ranges::all_of(grasp.constraints, is_met)) return true;
          continue;
        }
        const geom::Transform member =
            world::nearest_member(grasp, judge::product(inverse(at), object_pose));
        if (same(judge::product(at, member), object_pose)) return true;
      }
  return false;
}

std::optional<geom::Vec3> pushed_way(const world::World& world, std::size_t robot,
                                     std::uint32_t link, const geom::Transform& link_pose,
                                     std::size_t object, const geom::Transform& object_pose,
                                     double gap) {
  const auto is_push = [](const world::Feature& f) {
    return f.kind == world::Feature::Kind::Plane && f.name.starts_with("push");
  };
  for (const world::LinkFeature& front : world.robots[robot].features) {
    if (front.link != link || !is_push(front.feature)) continue;
    for (const world::Feature& side : world.objects[object].features) {
      if (!is_push(side)) continue;
      const geom::Vec3 way = link_pose.linear * front.feature.direction,
                       apart = object_pose * side.point - link_pose * front.feature.point;
      const double ahead = apart.dot(way);
      if ((way + object_pose.linear * side.direction).norm() <= kUpright + kSame &&
          std::abs(way.z()) <= kSame && ahead >= 0 && ahead <= gap &&
          (apart - ahead * way).norm() <= kSame)
        return way;
    }
  }
  return std::nullopt;
}

bool is_on_line(const geom::Transform& from, const geom::Vec3& way, const geom::Transform& now) {
  const geom::Vec3 gone = now.translation - from.translation;
  const double along = gone.dot(way);
  return along >= -kOffLine && (gone - along * way).norm() <= kOffLine &&
         (now.linear - from.linear).cwiseAbs().maxCoeff() <= kOffTurn;
}

bool is_on_seat(const world::World& world, std::size_t object, const geom::Transform& object_pose,
                std::size_t onto, const geom::Transform& onto_pose, double gap) {
  const auto plane = [](const world::Object& o, const char* name) -> const world::Feature* {
    for (const world::Feature& f : o.features)
      if (f.name == name && f.kind == world::Feature::Kind::Plane) return &f;
    return nullptr;
  };
  const world::Feature *mount = plane(world.objects[object], "mount"),
                       *special = plane(world.objects[onto],
                                        ("seat/" + world.objects[object].name).c_str()),
                       *seat = special != nullptr ? special : plane(world.objects[onto], "seat");
  if (mount == nullptr || seat == nullptr) return false;
  const geom::Vec3 normal = onto_pose.linear * seat->direction;
  return (object_pose * mount->point - onto_pose * seat->point).norm() <= gap + kSame &&
         (object_pose.linear * mount->direction + normal).norm() <= kSame;
}

bool is_mated(const world::World& world, const std::set<std::string>& sets, std::size_t object,
              const geom::Transform& object_pose, std::size_t onto,
              const geom::Transform& onto_pose) {
  const auto pose_of = [&](const world::FixedFeature& f) {
    return f.to != world::FixedFeature::To::Object ? nullptr
           : f.index == object                     ? &object_pose
           : f.index == onto                       ? &onto_pose
                                                   : nullptr;
  };
  const auto is_met = [&](world::ToleratedConstraint c) {
    // Tolerances are of the point of what was moved.
    if (c.first.index == onto) c = swapped(c);
    const geom::Transform *a = pose_of(c.first), *b = pose_of(c.second);
    return a != nullptr && b != nullptr && a != b && meets(c, *a, *b);
  };
  return std::ranges::any_of(world.constraints, [&](const world::ConstraintSet& set) {
    return sets.contains(set.name) && std::ranges::all_of(set.constraints, is_met);
  });
}

}  // namespace kaboum::execution
