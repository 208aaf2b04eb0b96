#pragma once

#include <kaboum/kinematics/closed_form.h>

#include <random>
#include <vector>

/// Arms of the tests, and poses computed by other means than the library.
namespace kaboum::test {

using namespace kaboum::kinematics;
using robot::Dh;

/// An arm as Denavit–Hartenberg rows (theta: the joints' offsets) between two fixed poses.
struct DhArm {
  std::vector<Dh> rows;
  bool distal = true;
  Transform base, tool;      ///< before the first row, after the last
  std::vector<double> sign;  ///< −1: the joint turns the other way; empty: none does
};

Arm arm_of(const DhArm& arm);

/// The tool's pose by plain products of 4 × 4 matrices of long doubles.
Transform reference_pose(const DhArm& arm, const std::vector<double>& q);

/// Arms of a family with random lengths (some 0), offsets, signs, bases and tools.
DhArm random_arm(Family family, std::mt19937_64& random);
/// Mitsubishi RV-6SL, in either convention. [m]
DhArm rv_6sl(bool distal);

Transform random_pose(std::mt19937_64& random, double size);
std::vector<double> random_joints(std::mt19937_64& random, std::size_t n, double range);

/// The largest difference of two configurations, whole turns apart.
double turn_distance(const double* a, const std::vector<double>& b);

}  // namespace kaboum::test
