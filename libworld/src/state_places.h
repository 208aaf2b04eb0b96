#pragma once

#include <kaboum/world/checker.h>

#include <memory>
#include <vector>

#include "balls.h"
#include "link_poses.h"

namespace kaboum::world {

namespace detail {
/// @throws Error{InvalidArgument} for states that do not fit the world, values that are not finite.
void require_fits(const World& world, const WorldState& state);
/// Bounds |LᵀL − I| (Frobenius) of the links' matrices in the world, but for rounding.
double defect_of(const RobotModel& robot, const LinkPoses& kinematics);
}  // namespace detail

/// Where all items are in a state; for the world that it was used for last.
///
/// Links are placed when they are asked for: most have only to be looked at as balls. For a ball of
/// radius r about c in an item's frame, and a matrix L that is a rotation up to |LᵀL − I| ≤ D, the
/// image of what is in the ball is within (1 + D) r of L c + t.
struct Scratch::Impl {
  std::shared_ptr<const char> checker;  ///< whose items these are
  std::vector<collide::PosedSet> sets;  ///< of all items
  std::vector<char> placed;             ///< whether `sets` has it where it is
  std::vector<Transform> poses;         ///< of all items, to the world
  std::vector<double> errors;           ///< of these poses [length]
  /// What holds an item, in its frame: all places that it may have are within `reach` and what is
  /// relative to the translation of the one of the ball's centre. D is at most 3e-9.
  struct Hull {
    Vec3 center;
    double reach;
  };
  std::vector<Hull> hulls;              ///< of all items
  detail::Balls balls;                  ///< of all items, in the world, with half_margin more
  double half_margin = 0;               ///< half of the largest margin of a pair [length]
  std::vector<collide::Memory> memory;  ///< of pairs of items, row by row; from their first use on
  std::vector<std::vector<Transform>> links;  ///< of all robots, to their roots

  std::vector<std::optional<Transform>> resting;  ///< where objects that rest were put last time
  struct HeldPlace {
    std::size_t robot = 0;
    std::uint32_t link = 0;
    Transform pose;
    double error = 0;
  };
  std::vector<std::optional<HeldPlace>> held;  ///< by objects, errors for the usual joint values

  /// Says that an item is where its pose is; its set is placed when it is asked for.
  void put(std::size_t i, double error) {
    placed[i] = 0;
    errors[i] = error;
    const Transform& pose = poses[i];
    const auto& [center, reach] = hulls[i];
    // Rounding of the centre is less than 2^-48 of the lengths.
    balls.put(i, pose * center, reach + error + half_margin + 1e-12 * pose.translation.lpNorm<1>());
  }

  /// @throws Error{InvalidArgument} as PosedSet::place
  const collide::PosedSet& set(std::size_t i) {
    if (placed[i] == 0) {
      sets[i].place(poses[i], errors[i]);
      placed[i] = 1;
    }
    return sets[i];
  }

  /// Whether the ball of item j is apart from the box of item i in the frame of i, by more than
  /// half_margin.
  [[nodiscard]] bool is_beside_box(std::size_t i, std::size_t j) const {
    // Within the radius of the place y of the ball: |p − L⁻¹y| ≤ (1 + D) radius for points p of the
    // box, and |Lᵀy − L⁻¹y| ≤ 2 D |y|.
    const Vec3 between = balls.center(j) - poses[i].translation;
    const Vec3 p = poses[i].linear.transpose() * between;
    const geom::Box3& box = sets[i].set().box();
    const Vec3 beside = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0);
    const double reach =
        (balls.radius(j) + errors[i] + half_margin) * (1 + 1e-8) + 1e-8 * between.lpNorm<1>();
    return beside.squaredNorm() > reach * reach;
  }
};

}  // namespace kaboum::world
