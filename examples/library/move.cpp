// A path for an arm among things, free of contacts at every instant, and its execution.

#include <kaboum/motion/find_path.h>
#include <kaboum/motion/trajectory.h>
#include <kaboum/robot/robot.h>

#include <iostream>

#include "box.h"

int main() {
  using namespace kaboum;
  // Sets that bound real links and objects come from certify::certify_robot and certify_set.
  const auto bound = [](const geom::Vec3& low, const geom::Vec3& high) {
    return world::BoundingSet({{"box", box(low, high)}}, collide::Direction::Outer, 0.001);
  };
  world::World cell;
  world::RobotModel& arm = cell.robots.emplace_back();
  arm.name = "arm";
  arm.kinematics = robot::parse_urdf(R"(
    <robot name="arm">
      <link name="base"/><link name="upper"/><link name="forearm"/>
      <joint name="shoulder" type="revolute">
        <parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
        <limit lower="-3" upper="3" effort="100" velocity="2"/>
      </joint>
      <joint name="elbow" type="revolute">
        <parent link="upper"/><child link="forearm"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
        <limit lower="-3" upper="3" effort="100" velocity="2"/>
      </joint>
    </robot>)",
                                     "arm.urdf");
  arm.home = {0, 0};
  for (const std::uint32_t link : {1U, 2U})
    arm.shapes.push_back({link, bound({0, -0.05, -0.05}, {1, 0.05, 0.05}), {}});
  arm.allowed.push_back({1, 2, world::AllowedPair::Reason::Adjacent});
  world::Object& post = cell.objects.emplace_back(
      world::Object{"post", {}, bound({-0.1, -0.1, -1}, {0.1, 0.1, 1}), {}, {}, {}});
  post.pose.translation = {1.5, 0, 0};
  cell.attachments.resize(cell.objects.size());

  const world::Checker checker(cell);
  const std::vector<double> start{-0.8, 0};  // [rad]
  const std::vector<std::vector<double>> goals{{0.8, 0}};
  const motion::PathAnswer answer =
      motion::find_path(checker, initial_state(cell), 0, start, goals, {});
  std::cout << "a path round the post: " << name_of(answer.outcome) << ", " << answer.path.size()
            << " waypoints\n";
  if (answer.outcome != motion::PathAnswer::Outcome::Found) return 1;
  const motion::Trajectory execution(answer.path, {{2, 2}, {5, 5}}, 1000);
  std::cout << execution.samples() << " samples at 1 kHz\n";
  return answer.straight ? 1 : 0;  // the straight line goes through it
}
