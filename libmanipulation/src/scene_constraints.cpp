// Constraints between named features of a scene, for kinematics::ConstraintSampler.
#include <kaboum/base/error.h>
#include <kaboum/manipulation/scene_constraints.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/features.h>

#include <algorithm>

namespace kaboum::manipulation {
namespace {

using Kind = kinematics::FrameId::Kind;

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

template <typename T>
std::size_t index_in(const std::vector<T>& list, const T& value) {
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), value) - list.begin());
}

}  // namespace

SceneConstraints::SceneConstraints(const world::World& world,
                                   const std::vector<std::pair<std::string, std::string>>& arms,
                                   const std::vector<std::string>& objects)
    : world_(world) {
  for (const auto& arm_of_scene : arms) {
    arms_.push_back(robot_named(arm_of_scene.first));
    const std::string& end = arm_of_scene.second;
    const world::RobotModel& robot = world.robots[arms_.back()];
    const auto tool = std::find_if(robot.tools.begin(), robot.tools.end(),
                                   [&](const world::ToolFrame& t) { return t.name == end; });
    const bool is_tool = tool != robot.tools.end();
    kinematics::PlacedArm arm{
        kinematics::arm_of(robot.kinematics, robot.kinematics.links.front().name,
                           is_tool ? robot.kinematics.links[tool->link].name : end),
        robot.base};
    if (is_tool) arm.arm.tool = arm.arm.tool * tool->pose;
    problem_.robots.push_back(std::move(arm));
  }
  for (const std::string& name : objects) {
    const auto object = world.find_object(name);
    if (!object) refuse("the scene has no object '" + name + "'");
    if (world.attachments[*object])
      refuse("object '" + name + "' is carried: its pose is not free");
    objects_.push_back(*object);
    problem_.objects.emplace_back();
  }
}

std::size_t SceneConstraints::robot_named(const std::string& name) const {
  if (const auto robot = world_.find_robot(name)) return *robot;
  refuse("the scene has no robot '" + name + "'");
}

kinematics::PlacedFeature SceneConstraints::on_link(std::size_t robot, std::uint32_t link,
                                                    const world::Feature& feature) {
  const world::RobotModel& model = world_.robots[robot];
  const std::size_t arm = index_in(arms_, robot);
  if (arm == arms_.size())
    return {{},
            kinematics_feature(
                moved(feature, model.base * robot::forward(model.kinematics, model.home)[link]))};
  kinematics::PlacedArm& placed = problem_.robots[arm];
  placed.links.push_back(kinematics::frame_of(model.kinematics, placed.arm,
                                              model.kinematics.links.front().name,
                                              model.kinematics.links[link].name));
  return {{Kind::Link, arm, placed.links.size() - 1}, kinematics_feature(feature)};
}

kinematics::PlacedFeature SceneConstraints::feature(const std::string& name) {
  using To = world::FixedFeature::To;
  const world::FixedFeature found = world::find_feature(world_, name);
  if (found.to == To::Object) {
    const std::size_t sought = index_in(objects_, found.index);
    if (sought < objects_.size())
      return {{Kind::Object, sought}, kinematics_feature(found.feature)};
  }
  const world::FixedFeature here = at_state(world_, initial_state(world_), found);
  if (here.to == To::Link) return on_link(here.index, here.link, here.feature);
  return {{}, kinematics_feature(here.feature)};
}

}  // namespace kaboum::manipulation
