// What motions of the external functions keep, for those who carry them out another way.

#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/manipulation/kept_constraints.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "push_contact.h"

namespace kaboum::manipulation {
namespace {

using world::Transform;

/// Of whose motions only the ends and the constraints matter.
constexpr std::array<std::string_view, 16> kFree{
    "reach", "grasp", "place",    "transfer", "fetch",   "put",  "putUpright", "lift",
    "join",  "push",  "handOver", "wander",   "release", "move", "satisfy",    "mate"};

std::size_t object_named(const world::World& world, const std::string& name) {
  const auto found = world.find_object(name);
  if (!found) throw Error(ErrorCode::InvalidInput, "the scene has no object '" + name + "'");
  return *found;
}

}  // namespace

std::optional<std::vector<motion::PathConstraint>> kept_constraints(
    const world::World& world, const world::WorldState& state, std::size_t robot,
    const robot::Path& path, const std::string& function,
    const std::vector<std::string>& arguments) {
  if (std::ranges::find(kFree, function) == kFree.end() || path.empty()) return std::nullopt;
  std::vector<motion::PathConstraint> out = motion::carried_constraints(world, state, robot);
  const bool upright = function == "putUpright", pushes = function == "push";
  if (!upright && !pushes) return out;
  if (arguments.size() < 3) return std::nullopt;
  const std::size_t object = object_named(world, arguments[1]),
                    support = object_named(world, arguments[2]);
  const auto& held = state.attachments[object];
  if (!held || held->robot != robot) return out;
  const ExternalOptions usual;
  if (upright) {
    out.push_back(motion::upright_constraint(world, *held, object, usual.upright));
    return out;
  }
  const world::RobotModel& model = world.robots[robot];
  const auto object_at = [&](const std::vector<double>& q) {
    return model.base * robot::forward(model.kinematics, q)[held->link] * held->pose;
  };
  const Transform begin = object_at(path.front()), end = object_at(path.back());
  const PushedObject pushed(world.objects[object], begin, world.objects[support],
                            state.poses[support], usual.clearance);
  geom::Vec3 way = end.translation - begin.translation;
  way.z() = 0;
  const double length = way.norm();
  if (!pushed.refusal().empty() || !(length > 0)) return std::nullopt;
  for (motion::PathConstraint& c :
       push_constraints(*held, begin, pushed.center(), way / length, length))
    out.push_back(std::move(c));
  return out;
}

}  // namespace kaboum::manipulation
