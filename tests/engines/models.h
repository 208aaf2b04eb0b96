#pragma once

#include <gtest/gtest.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/dynamics.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/robot_file.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

/// Robots that outputs.sh has written in several formats, and what our library says of them.
namespace engines {

struct WrittenRobot {
  std::filesystem::path urdf;
  std::string prefix;  ///< of names of meshes in URDF and SDF
  kaboum::robot::Robot robot;
  kaboum::robot::Dynamics dynamics;
};

inline std::vector<WrittenRobot> written() {
  const std::filesystem::path folder = KABOUM_ENGINE_OUTPUTS;
  std::ifstream list(folder / "formats.txt");
  std::vector<WrittenRobot> out;
  for (std::string line; std::getline(list, line);) {
    const std::string urdf = (folder / line).string();
    const std::vector<char> text = kaboum::io::read_file(urdf);
    const bool prefixed =
        line.starts_with("formats/" + std::filesystem::path(line).stem().string());
    out.push_back(
        {urdf, prefixed ? "cell/" + std::filesystem::path(line).parent_path().string() + "/" : "",
         kaboum::robot::read_robot(urdf).robot,
         kaboum::robot::parse_dynamics({text.data(), text.size()}, urdf)});
  }
  EXPECT_GE(out.size(), 5U) << "run the test engines.outputs first";
  return out;
}

/// Values within the limits, the same every time.
inline std::vector<double> configuration(const kaboum::robot::Robot& robot, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> q;
  for (const kaboum::robot::Variable& v : robot.variables) {
    const double lower = v.lower.value_or(-3), upper = v.upper.value_or(3);
    q.push_back(lower + (upper - lower) * static_cast<double>(random() % 1000) / 999);
  }
  return q;
}

inline double value_of(const kaboum::robot::Joint& joint, const std::vector<double>& q) {
  return joint.multiplier * q[joint.variable] + joint.offset;
}

inline void expect_pose(const kaboum::robot::Transform& ours, const Eigen::Matrix3d& rotation,
                        const Eigen::Vector3d& translation, const std::string& what) {
  EXPECT_LT((ours.linear - rotation).cwiseAbs().maxCoeff(), 1e-9) << what;
  EXPECT_LT((ours.translation - translation).cwiseAbs().maxCoeff(), 1e-9) << what;
}

}  // namespace engines
