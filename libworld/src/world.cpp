// Names and places of what is in a world.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/world.h>

namespace kaboum::world {

const char* name_of(AllowedPair::Reason reason) {
  switch (reason) {
    case AllowedPair::Reason::Adjacent:
      return "adjacent";
    case AllowedPair::Reason::Never:
      return "never";
    case AllowedPair::Reason::Always:
      return "always";
    default:
      return "stated";
  }
}

std::optional<std::uint32_t> World::point_of(const Item& item, std::size_t body) const {
  if (item.robot != Item::kObject || objects[item.index].point_numbers.empty()) return std::nullopt;
  return objects[item.index].point_numbers.at(body);
}

std::string World::name_of(const Item& item) const {
  if (item.robot == Item::kObject) return objects[item.index].name;
  const RobotModel& robot = robots[item.robot];
  return robot.name + "/" + robot.kinematics.links[robot.shapes[item.index].link].name;
}

std::optional<std::size_t> World::find_robot(const std::string& name) const {
  for (std::size_t i = 0; i < robots.size(); ++i)
    if (robots[i].name == name) return i;
  return std::nullopt;
}

std::optional<std::size_t> World::find_object(const std::string& name) const {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].name == name) return i;
  return std::nullopt;
}

const ConstraintSet& World::constraint_set(const std::string& name) const {
  std::vector<std::string> names;
  for (const ConstraintSet& set : constraints) {
    if (set.name == name) return set;
    names.push_back(set.name);
  }
  throw Error(ErrorCode::InvalidArgument,
              "the scene has no constraints '" + name + "'" + did_you_mean(name, names));
}

const BoundingSet& World::outer(const Item& item) const {
  return item.robot == Item::kObject ? objects[item.index].outer
                                     : robots[item.robot].shapes[item.index].outer;
}

const std::optional<BoundingSet>& World::inner(const Item& item) const {
  return item.robot == Item::kObject ? objects[item.index].inner
                                     : robots[item.robot].shapes[item.index].inner;
}

WorldState initial_state(const World& world) {
  WorldState out;
  for (const RobotModel& robot : world.robots) out.q.push_back(robot.home);
  for (const Object& object : world.objects) out.poses.push_back(object.pose);
  out.attachments = world.attachments;
  out.attachments.resize(world.objects.size());
  set_grippers(world, out);
  return out;
}

}  // namespace kaboum::world
