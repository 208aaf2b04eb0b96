// The geometric state of a planner's state: components conf(robot) and pose(object).
#include "geometric_state.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/manipulation/words.h>

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

/// The value of FUNCTION(NAME), `otherwise` where the domain has no such term; nullopt: not known.
std::optional<std::string> value(Geometry& geometry, plan::StateView& view,
                                 const std::string& function, const std::string& name,
                                 std::string_view otherwise) {
  const std::string term = function + "(" + name + ")";
  if (geometry.fixed.contains(term)) return std::string(otherwise);
  try {
    return view.value(function, {name});
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput) throw;
  }
  geometry.fixed.insert(term);
  return std::string(otherwise);
}

}  // namespace

std::size_t robot_named(const Geometry& geometry, const std::string& name) {
  return find_named(geometry.world.robots, name, "robot");
}

std::size_t object_named(const Geometry& geometry, const std::string& name) {
  return find_named(geometry.world.objects, name, "object");
}

GeometricState read_state(Geometry& geometry, plan::StateView& view) {
  const world::World& world = geometry.world;
  GeometricState out{initial_state(world), ""};
  out.state.absent.assign(world.objects.size(), false);
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    const auto word = value(geometry, view, "conf", world.robots[r].name, kHome);
    if (!word) {
      out.unknown = "the configuration of " + world.robots[r].name + " is not known";
      return out;
    }
    out.state.q[r] = configuration_of(*word, world.robots[r]);
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    const auto word = value(geometry, view, "pose", world.objects[o].name, kStart);
    if (!word) {
      out.unknown = "the pose of " + world.objects[o].name + " is not known";
      return out;
    }
    const ObjectPlace place = place_of(*word, world, o);
    out.state.absent[o] = place.absent;
    if (!place.absent && !place.attachment) out.state.poses[o] = place.pose;
    out.state.attachments[o] = place.attachment;
  }
  return out;
}

}  // namespace kaboum::manipulation
