#pragma once

#include <kaboum/manipulation/externals.h>
#include <kaboum/world/checker.h>

#include <map>
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
  /// Paths in a world without what the domain moves, by all that they depend on: nothing that was
  /// asked before has a say in them.
  mutable std::map<std::string, robot::Path> usual_paths;
  /// Likewise, where one robot hands something over to another one: the first one's configuration.
  mutable std::map<std::string, std::vector<double>> usual_meetings;
  mutable world::Scratch scratch;
};

/// @throws Error{InvalidInput} for names that the scene does not have.
std::size_t robot_named(const Geometry& geometry, const std::string& name);
std::size_t object_named(const Geometry& geometry, const std::string& name);

/// The state of the world as the planner knows it, as far as it was read: what is read is in the
/// footprint of the call. Things that were not read are as in the scene, objects absent.
class GeometricState {
 public:
  GeometricState(Geometry& geometry, plan::StateView& view);

  /// Reads the configuration of a robot. @return false: it is not known.
  bool read_robot(std::size_t robot);
  /// Reads where an object is, and what it is mounted on; of what holds it the configuration too.
  bool read_object(std::size_t object);
  bool read_all();
  /// A configuration that the call states: the state's is not read.
  void set_robot(std::size_t robot, std::vector<double> q) { state_.q[robot] = std::move(q); }

  [[nodiscard]] const world::WorldState& world() const { return state_; }
  /// What each object is mounted on, as far as it was read.
  [[nodiscard]] const std::vector<std::optional<std::size_t>>& mounted() const { return mounted_; }
  /// A sentence, when something is not known.
  [[nodiscard]] const std::string& unknown() const { return unknown_; }

 private:
  bool read_place(std::size_t object, std::size_t depth);

  Geometry& geometry_;
  plan::StateView& view_;
  world::WorldState state_;
  std::vector<std::optional<std::size_t>> mounted_;
  std::vector<bool> robots_read_, objects_read_;
  std::string unknown_;
};

}  // namespace kaboum::manipulation
