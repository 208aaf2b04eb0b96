// The geometric state of a planner's state: components conf(robot) and pose(object).
#include "geometric_state.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/gripper.h>

#include <algorithm>

namespace kaboum::manipulation {
namespace {

template <class Things>
std::size_t find_named(const Things& things, const std::string& name, const char* kind) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (things[i].name == name) return i;
    names.push_back(things[i].name);
  }
  throw Error(ErrorCode::InvalidInput, "the scene has no " + std::string(kind) + " '" + name + "'" +
                                           did_you_mean(name, names));
}

}  // namespace

std::size_t robot_named(const Geometry& geometry, const std::string& name) {
  return find_named(geometry.world.robots, name, "robot");
}

std::size_t object_named(const Geometry& geometry, const std::string& name) {
  return find_named(geometry.world.objects, name, "object");
}

std::size_t region_named(const Geometry& geometry, const std::string& name) {
  return find_named(geometry.world.regions, name, "region");
}

world::MotionOptions check_of(const Geometry& geometry, std::size_t robot,
                              const std::vector<std::optional<world::Attachment>>& attachments,
                              const std::vector<double>& beside) {
  world::MotionOptions out = geometry.check;
  out.around = finger_room(geometry.world, robot, attachments);
  if (out.around.empty())
    out.around = beside;
  else
    for (std::size_t i = 0; i < beside.size(); ++i) out.around[i] += beside[i];
  return out;
}

GeometricState::GeometricState(Geometry& geometry, plan::StateView& view)
    : geometry_(geometry),
      view_(view),
      state_(initial_state(geometry.world)),
      mounted_(geometry.world.objects.size()),
      robots_read_(geometry.world.robots.size(), false),
      objects_read_(geometry.world.objects.size(), false),
      finger_room_(geometry.world.robots.size()) {
  // What was not read is held by nobody: fingers are as what is read decides.
  std::ranges::fill(state_.attachments, std::nullopt);
  set_grippers(geometry.world, state_);
  state_.absent.assign(objects_read_.size(), true);
  if (geometry_.fixed_robots.size() < robots_read_.size() ||
      geometry_.fixed_objects.size() < objects_read_.size())
    find_fixed();
}

void GeometricState::find_fixed() {
  geometry_.fixed_robots.clear();
  for (const world::RobotModel& robot : geometry_.world.robots)
    geometry_.fixed_robots.push_back(view_.has_term("conf", {robot.name}) ? 0 : 1);
  geometry_.fixed_objects.clear();
  for (const world::Object& object : geometry_.world.objects)
    geometry_.fixed_objects.push_back(view_.has_term("pose", {object.name}) ? 0 : 1);
}

bool GeometricState::read_robot(std::size_t robot) {
  if (robots_read_[robot]) return true;
  const world::RobotModel& model = geometry_.world.robots[robot];
  const auto word =
      geometry_.is_fixed_robot(robot) ? std::string(kHome) : view_.value("conf", {model.name});
  if (!word) {
    unknown_ = "the configuration of " + model.name + " is not known";
    return false;
  }
  state_.q[robot] = configuration_of(*word, model);
  if (!read_fingers(robot)) return false;
  robots_read_[robot] = true;
  return true;
}

/// Puts the joints of a robot's grippers where they are: what it holds decides that.
bool GeometricState::read_fingers(std::size_t robot) {
  const world::World& world = geometry_.world;
  if (!has_finger_joints(world.robots[robot])) return true;
  std::vector<std::optional<world::Attachment>> held(world.objects.size());
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    if (world.objects[o].grasps.empty() && !world.attachments[o]) continue;
    const auto word = geometry_.is_fixed_object(o) ? std::string(kStart)
                                                   : view_.value("pose", {world.objects[o].name});
    if (!word) {
      unknown_ = "the pose of " + world.objects[o].name + " is not known";
      return false;
    }
    held[o] = place_of(*word, world, o).attachment;
  }
  set_grippers(world, robot, held, state_.q[robot]);
  finger_room_[robot] = world::finger_room(world, robot, held);
  return true;
}

bool GeometricState::read_object(std::size_t object) { return read_place(object, 0); }

bool GeometricState::read_place(std::size_t object, std::size_t depth) {
  if (objects_read_[object]) return true;
  const world::World& world = geometry_.world;
  if (depth > world.objects.size())
    throw Error(ErrorCode::InvalidInput, "objects are mounted on each other in a circle; one is " +
                                             world.objects[object].name);
  const auto word = geometry_.is_fixed_object(object)
                        ? std::string(kStart)
                        : view_.value("pose", {world.objects[object].name});
  if (!word) {
    unknown_ = "the pose of " + world.objects[object].name + " is not known";
    return false;
  }
  ObjectPlace place = place_of(*word, world, object);
  if (const auto below = place.mounted_on) {
    mounted_[object] = below;
    if (!read_place(*below, depth + 1)) return false;
    place.absent = state_.absent[*below];
    place.attachment = state_.attachments[*below];
    if (place.attachment)
      place.attachment = carried_along(*place.attachment, place.pose);
    else
      place.pose = state_.poses[*below] * place.pose;
  }
  if (place.attachment && !read_robot(place.attachment->robot)) return false;
  state_.absent[object] = place.absent;
  if (!place.absent && !place.attachment) state_.poses[object] = place.pose;
  state_.attachments[object] = place.absent ? std::nullopt : place.attachment;
  objects_read_[object] = true;
  return true;
}

bool GeometricState::read(std::span<const std::size_t> robots,
                          std::span<const std::size_t> objects) {
  for (const std::size_t r : robots)
    if (!read_robot(r)) return false;
  for (const std::size_t o : objects)
    if (!read_object(o)) return false;
  for (std::size_t r = 0; r < robots_read_.size(); ++r)
    if (geometry_.is_fixed_robot(r) && !read_robot(r)) return false;
  for (std::size_t o = 0; o < objects_read_.size(); ++o)
    if (geometry_.is_fixed_object(o) && !read_object(o)) return false;
  return true;
}

bool GeometricState::read_all() {
  for (std::size_t r = 0; r < robots_read_.size(); ++r)
    if (!read_robot(r)) return false;
  for (std::size_t o = 0; o < objects_read_.size(); ++o)
    if (!read_object(o)) return false;
  return true;
}

}  // namespace kaboum::manipulation
