#pragma once

#include <kaboum/kinematics/sample.h>

#include <vector>

// Where the frames of a constraint problem are, and by which unknowns they move. Internal to
// kaboum_kinematics.
namespace kaboum::kinematics {

using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// How a frame's pose depends on the unknowns: a block of columns.
struct Frame {
  Transform pose;
  Eigen::Index first = 0, count = 0;
  bool rigid = true;  ///< six unknowns: the twist itself; else `twists`
  Twists twists;      ///< of the frame's origin, by the unknowns of the block
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

  /// nullptr: the world's.
  [[nodiscard]] const Frame* find(const FrameId& id) const;
};

/// The costs of all constraints, and their derivative by the unknowns.
void assemble(const std::vector<Constraint>& constraints, const Frames& frames, double length,
              Costs& out);

/// Features of links that rest or move with the tool as such of the world or the tool.
std::vector<Constraint> without_end_links(const ConstraintProblem& problem);

}  // namespace kaboum::kinematics
