// What a robot sweeps: a URDF, its kinematics, and convex bodies that hold a link during a motion.

#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path.h>
#include <kaboum/sweep/sweep.h>

#include <iostream>

int main() {
  using namespace kaboum;
  const robot::Robot arm = robot::parse_urdf(R"(
    <robot name="arm">
      <link name="base"/>
      <link name="forearm">
        <collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision>
      </link>
      <joint name="elbow" type="continuous">
        <parent link="base"/><child link="forearm"/><axis xyz="0 0 1"/>
      </joint>
    </robot>)",
                                             "arm.urdf");
  const robot::Path quarter{{0}, {1.5707963}};  // [rad]
  const geom::Vec3 tip = robot::forward(arm, quarter.back())[1] * geom::Vec3(1, 0, 0);

  const robot::LinkBody forearm{"forearm", 1, robot::bounding_points(arm.links[1].collision[0]), 0};
  sweep::SweepOptions options;
  options.epsilon = 0.01;  // [m]
  const sweep::SweepResult swept = sweep::swept_volume(arm, {&forearm, 1}, quarter, options);
  std::cout << "the tip ends at (" << tip.transpose() << "); " << swept.set.bodies.size()
            << " bodies and a margin of " << geom::margin_of(swept.set).value_or(0)
            << " hold the motion\n";
  return swept.certified && !swept.set.bodies.empty() ? 0 : 1;
}
