// Constraints between named features of a scene, for kinematics::ConstraintSampler.
#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/manipulation/scene_constraints.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>

namespace kaboum::manipulation {
namespace {

using Kind = kinematics::FrameId::Kind;

/// In a frame in which the feature's own has this pose.
kinematics::Feature placed_feature(const world::Feature& f, const geom::Transform& pose) {
  const geom::Vec3 point = pose * f.point;
  if (f.kind == world::Feature::Kind::Point) return kinematics::Point{point};
  const geom::Vec3 direction = (pose.linear * f.direction).normalized();
  if (f.kind == world::Feature::Kind::Line) return kinematics::Line{point, direction};
  return kinematics::Plane{point, direction};
}

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

/// The only one of that name.
template <typename Features, typename NameOf>
const auto& only_feature(const Features& features, const std::string& name, const NameOf& name_of) {
  std::vector<std::string> names;
  names.reserve(features.size());
  for (const auto& f : features) names.push_back(name_of(f));
  const auto first = std::find(names.begin(), names.end(), name);
  if (first == names.end())
    refuse("there is no feature '" + name + "'" + did_you_mean(name, names));
  if (std::find(first + 1, names.end(), name) != names.end())
    refuse("the feature '" + name + "' is there in two kinds: give them different names");
  return features[static_cast<std::size_t>(first - names.begin())];
}

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
                                                    const geom::Transform& pose,
                                                    const world::Feature& feature) {
  const world::RobotModel& model = world_.robots[robot];
  const std::size_t arm = index_in(arms_, robot);
  if (arm == arms_.size())
    return {{},
            placed_feature(feature,
                           model.base * robot::forward(model.kinematics, model.home)[link] * pose)};
  kinematics::PlacedArm& placed = problem_.robots[arm];
  placed.links.push_back(kinematics::frame_of(model.kinematics, placed.arm,
                                              model.kinematics.links.front().name,
                                              model.kinematics.links[link].name));
  return {{Kind::Link, arm, placed.links.size() - 1}, placed_feature(feature, pose)};
}

kinematics::PlacedFeature SceneConstraints::feature(const std::string& name) {
  const auto slash = name.find('/');
  if (slash == std::string::npos)
    refuse("'" + name + "': a feature is named ROBOT/FEATURE or OBJECT/FEATURE");
  const std::string owner = name.substr(0, slash), own = name.substr(slash + 1);
  if (const auto object = world_.find_object(owner)) {
    const world::Object& o = world_.objects[*object];
    const auto& f = only_feature(o.features, own, [](const auto& x) { return x.name; });
    const std::size_t sought = index_in(objects_, *object);
    if (sought < objects_.size()) return {{Kind::Object, sought}, placed_feature(f, {})};
    if (const auto& held = world_.attachments[*object])
      return on_link(held->robot, held->link, held->pose, f);
    return {{}, placed_feature(f, o.pose)};
  }
  const std::size_t robot = robot_named(owner);
  const world::LinkFeature& f = only_feature(world_.robots[robot].features, own,
                                             [](const auto& x) { return x.feature.name; });
  return on_link(robot, f.link, {}, f.feature);
}

}  // namespace kaboum::manipulation
