#pragma once

#include <kaboum/sweep/sweep.h>

#include <random>
#include <string>

namespace kaboum::test {

using namespace kaboum::sweep;

/// A robot with one convex body per link that has a shape.
struct TestRobot {
  std::string name;
  Robot robot;
  std::vector<Body> bodies;
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

/// Distance of a point from a convex polytope, 0 inside. Rounded arithmetic.
double distance_to(const geom::Mesh& hull, const Vec3& point);

/// Samples points of the bodies at configurations of the path and looks for those outside the set.
struct Missed {
  std::size_t tested = 0, missed = 0;
  double largest = 0;  ///< distance from the polytopes, without the margin
};
/// By default a sample is compared with the piece of its time; `anywhere`: with all hulls.
Missed sample_points(const TestRobot& robot, const Path& path, const SweepResult& result,
                     std::mt19937_64& random, std::size_t samples, bool anywhere = false);

/// The first hull that is not exactly convex, not in float32, or does not contain all images of
/// its body's points (rounded to float32), by exact predicates; nullopt when all are right.
std::optional<std::size_t> find_bad_hull(const TestRobot& robot, const SweepResult& result);

}  // namespace kaboum::test
