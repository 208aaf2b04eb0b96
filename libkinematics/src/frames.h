#pragma once

#include <kaboum/kinematics/sample.h>

#include <cmath>
#include <vector>

// Where the frames of a constraint problem are, and by which unknowns they move. Internal to
// kaboum_kinematics.
namespace kaboum::kinematics {

/// How a frame's pose depends on the unknowns: a block of columns.
struct Frame {
  Transform pose;
  Eigen::Index first = 0, count = 0;
  bool rigid = true;  ///< six unknowns: the twist itself; else `twists`
  Jacobian twists;    ///< of the frame's origin, by the unknowns of the block
};

/// Poses of everything, and the unknowns.
struct Frames {
  std::vector<Frame> tools, objects;
  std::vector<std::vector<Frame>> links;  ///< of each robot
  Eigen::Index unknowns = 0;

  /// A robot's tool with these unknowns, and its links where they are its joints.
  void add_robot(const PlacedArm& robot, bool rigid);
  void add_object();
  /// Tool and links of a robot that is not rigid, at these joints.
  void place(const PlacedArm& robot, std::size_t index, const std::vector<double>& q);
  /// The same without derivatives.
  void place_poses(const PlacedArm& robot, std::size_t index, const std::vector<double>& q);

  /// nullptr: the world's.
  [[nodiscard]] const Frame* find(const FrameId& id) const;
};

/// The costs of all constraints, and their derivative by the unknowns.
void assemble(const std::vector<Constraint>& constraints, const Frames& frames, double length,
              Costs& out);

/// The larger number; NaN where one is.
inline double larger(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// The largest magnitude of all costs; NaN where one is.
double largest_cost(const std::vector<Constraint>& constraints, const Frames& frames,
                    double length);

/// Features of links that rest or move with the tool as such of the world or the tool.
std::vector<Constraint> without_end_links(const ConstraintProblem& problem);

}  // namespace kaboum::kinematics
