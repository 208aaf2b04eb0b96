#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/robot/link_body.h>
#include <kaboum/robot/path.h>

#include <random>
#include <span>
#include <string>
#include <vector>

namespace kaboum::test {

using namespace kaboum::robot;

/// A robot with one convex body per link that has a shape.
struct TestRobot {
  std::string name;
  Robot robot;
  std::vector<LinkBody> bodies;
};

/// Six revolute axes; 1.18 m from the first axis to the farthest corner, summing up all links.
TestRobot six_axis_arm();
/// Revolute, prismatic, revolute, prismatic, revolute; skew axes and rotated origins.
TestRobot prismatic_chain();
/// UR5, KR120 and Puma 560 with hulls of extreme vertices of their links' meshes, from
/// $KABOUM_MESHES; empty without it.
std::vector<TestRobot> real_robots();
/// All of the above.
std::vector<TestRobot> test_robots();

/// Text of the robot's file in $KABOUM_MESHES/robots; empty when there is none.
std::string robot_file(const std::string& path);

/// A path of random waypoints within ±range; `subset`: about half of the variables stay.
Path random_path(const Robot& robot, std::mt19937_64& random, std::size_t waypoints, double range,
                 bool subset);

/// Poses computed by other means than the library: 4 × 4 matrices in long double, joint by joint.
Transform reference_pose(const Robot& robot, std::uint32_t link, std::span<const double> q);

/// Configuration between two waypoints.
std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double s);

/// Distance of a point from the segment ab. Rounded arithmetic.
double segment_distance(const Vec3& a, const Vec3& b, const Vec3& p);

/// Distance of a point from a convex polytope, 0 inside. Rounded arithmetic.
double distance_to(const geom::Mesh& hull, const Vec3& point);

}  // namespace kaboum::test
