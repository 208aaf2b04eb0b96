#pragma once

#include <optional>
#include <vector>

#include "random_scene.h"

namespace kaboum::test {

/// Decides what it can about a random scene by trying: configurations by Newton's method from many
/// starts, with the judge's kinematics; contacts among the judge's exact meshes, blocks and boxes
/// grown a little; paths of a few straight pieces, looked at in small steps. What it finds is
/// there; where it finds nothing there may be something all the same. It has none of the code of
/// worlds, inverse kinematics, motions and planning.
class BruteForce {
 public:
  explicit BruteForce(const RandomScene& scene) : scene_(scene) {}

  /// Configurations within the limits where the robot's hand has a pose.
  [[nodiscard]] std::vector<std::vector<double>> configurations(
      std::size_t robot, const geom::Transform& target) const;

  struct Reach {
    std::size_t grasp = 0;
    std::vector<double> q;
  };
  /// Where the robot's tool is at one of the block's grasps, free of contact before and after it
  /// takes the block.
  /// @param every  all that are found; else the first.
  [[nodiscard]] std::vector<Reach> free_reaches(const judge::CellState& state, std::size_t robot,
                                                std::size_t block, bool every) const;

  /// Whether a sequence of actions meets the task's goal, with paths there and back.
  /// @param step  between samples of paths. [rad]
  [[nodiscard]] bool has_solution(double step) const;

  [[nodiscard]] bool is_free(const judge::CellState& state, std::size_t robot) const {
    return !scene_.grown.find_meeting(state, robot);
  }
  /// Of a block in a robot's hand.
  [[nodiscard]] judge::Hold hold(std::size_t robot, std::size_t block, std::size_t grasp) const;

 private:
  using Path = std::vector<std::vector<double>>;
  [[nodiscard]] std::optional<std::vector<double>> newton(std::size_t robot,
                                                          const geom::Transform& target,
                                                          std::vector<double> q) const;
  [[nodiscard]] bool is_free_along(judge::CellState state, std::size_t robot, const Path& path,
                                   double step) const;
  /// Ways from the robot's home to a configuration: straight, and over a place where the hand is
  /// backed off; both over random configurations.
  [[nodiscard]] std::vector<Path> ways(std::size_t robot, const std::vector<double>& q) const;
  [[nodiscard]] bool search(const judge::CellState& state, std::vector<bool> removed,
                            std::vector<bool> stowed, double step, int depth) const;

  const RandomScene& scene_;
};

}  // namespace kaboum::test
