// The exact meshes of a scene, to judge by.

#include <kaboum/base/error.h>
#include <kaboum/execution/exact_cell.h>
#include <kaboum/world/exact_meshes.h>

namespace kaboum::execution {
namespace fs = std::filesystem;

judge::Cell exact_cell(const world::World& world, const fs::path& scene,
                       const std::vector<std::string>& packages, Notes& notes) {
  judge::Cell cell;
  for (const world::RobotModel& robot : world.robots)
    cell.add_robot(robot.name, robot.kinematics, robot.base);
  for (const world::ExactMesh& exact : exact_meshes(world, scene, packages)) {
    const auto [robot, index] = exact.item;
    if (robot == world::Item::kObject)
      cell.add_object(world.objects[index].name, exact.mesh);
    else
      cell.add_link(robot, world.robots[robot].shapes[index].link, exact.mesh);
  }
  for (const world::RobotModel& robot : world.robots)
    for (const world::AllowedPair& pair : robot.allowed)
      if (pair.reason == world::AllowedPair::Reason::Stated)
        cell.allow(robot.name + "/" + robot.kinematics.links[pair.a].name,
                   robot.name + "/" + robot.kinematics.links[pair.b].name);
  for (const auto& pair : world.allowed) cell.allow(world.name_of(pair[0]), world.name_of(pair[1]));
  if (cell.open() > 0)
    notes.push_back(std::to_string(cell.open()) +
                    " of the exact meshes are not closed: what lies wholly inside of them is not "
                    "seen to touch them");
  return cell;
}

}  // namespace kaboum::execution
