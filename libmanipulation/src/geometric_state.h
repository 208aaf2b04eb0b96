#pragma once

#include <kaboum/manipulation/externals.h>
#include <kaboum/world/checker.h>

#include <set>

namespace kaboum::manipulation {

/// A world, and what is asked of it again and again.
struct Geometry {
  Geometry(world::World w, const ExternalOptions& o)
      : world(std::move(w)), options(o), checker(world) {}
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  const world::World world;
  const ExternalOptions options;
  const world::Checker checker;
  std::set<std::string> fixed;  ///< terms that the domain does not have
};

/// @throws Error{InvalidInput} for names that the scene does not have.
std::size_t robot_named(const Geometry& geometry, const std::string& name);
std::size_t object_named(const Geometry& geometry, const std::string& name);

/// The state of the world as the planner knows it, or why it is not known.
struct GeometricState {
  world::WorldState state;
  std::string unknown;  ///< a sentence, when something is not known
};

/// Reads the configurations of all robots and the poses of all objects: all are in the footprint.
GeometricState read_state(Geometry& geometry, plan::StateView& view);

}  // namespace kaboum::manipulation
