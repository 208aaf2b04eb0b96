#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/judge/cell.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot.h>
#include <kaboum/world/scene.h>

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace kaboum::benchmarks {

/// A value of JSON for each line of a file.
std::vector<nlohmann::json> read_lines(const char* name);

/// A robot's world with objects: each has a name, a position, a quaternion and a shape.
world::World with_objects(const world::World& robot, const nlohmann::json& objects);

/// The shapes for collisions of a link as one mesh in its frame, as they are in the files; round
/// ones as the polytopes that stand for a scene's.
geom::Mesh mesh_of_link(const robot::Link& link, robot::MeshFiles& files);

/// The exact meshes of a robot's links, and cells of them with objects.
class JudgedRobot {
 public:
  JudgedRobot(const world::RobotModel& model, const char* urdf);

  /// @param state  gets the places of the objects, and the robot at home
  std::unique_ptr<judge::Cell> cell(const world::World& world, judge::CellState& state) const;

 private:
  const world::RobotModel& model_;
  std::vector<std::pair<std::uint32_t, geom::Mesh>> links_;
};

}  // namespace kaboum::benchmarks
