#pragma once

#include <kaboum/world/checker.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

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
  /// Of all items' balls in the world; rounded, the radii large enough for that. A few more, so
  /// that there are four to look at everywhere.
  std::vector<float> x, y, z, radius;
  std::vector<std::int32_t> apart;            ///< of balls, see look_from
  std::vector<collide::Memory> memory;        ///< of pairs of items, row by row
  std::vector<std::vector<Transform>> links;  ///< of all robots, to their roots

  std::vector<Transform> resting;  ///< the state's poses last time; empty: something was attached
  struct Held {
    std::size_t robot = 0;
    std::uint32_t link = 0;
    Transform pose;
    double error = 0;
  };
  std::vector<std::optional<Held>> held;  ///< by objects, errors for the usual joint values

  /// Says where an item is; its set is placed when it is asked for.
  void put(std::size_t i, const Transform& pose, double error) {
    placed[i] = 0;
    poses[i] = pose;
    errors[i] = error;
    const collide::BoundingSet::Ball& ball = sets[i].set().ball();
    const Vec3 center = pose * ball.center;
    x[i] = static_cast<float>(center.x());
    y[i] = static_cast<float>(center.y());
    z[i] = static_cast<float>(center.z());
    // Rounding of the centre is less than 2^-48 of the lengths, and to floats 2^-23 of the place;
    // D is at most 3e-9. The rest is for the rounding of look_from.
    radius[i] =
        static_cast<float>((ball.radius * (1 + 1e-8) + error +
                            1e-12 * (pose.translation.lpNorm<1>() + ball.center.lpNorm<1>()) +
                            0x1p-22 * center.lpNorm<1>()) *
                               (1 + 0x1p-19) +
                           1e-15);
  }

  /// @throws Error{InvalidArgument} as PosedSet::place
  const collide::PosedSet& set(std::size_t i) {
    if (placed[i] == 0) {
      sets[i].place(poses[i], errors[i]);
      placed[i] = 1;
    }
    return sets[i];
  }

  /// Sets apart[j] to other than 0 only where the balls of items i and j, j > i, are apart.
  ///
  /// Differences, squares and sums of floats err by less than 2^-20 together (the parts of a sum
  /// are not negative), which the radii are larger by; what is too large for floats is not apart.
  void look_from(std::size_t i) {
    using Floats [[gnu::vector_size(16)]] = float;
    using Ints [[gnu::vector_size(16)]] = std::int32_t;
    const auto all = [](float f) { return Floats{f, f, f, f}; };
    const auto four = [](const std::vector<float>& from, std::size_t at) {
      Floats out;
      std::memcpy(&out, from.data() + at, sizeof out);
      return out;
    };
    const Floats xi = all(x[i]), yi = all(y[i]), zi = all(z[i]), ri = all(radius[i]);
    for (std::size_t j = (i + 1) & ~std::size_t{3}; j < apart.size(); j += 4) {
      const Floats dx = four(x, j) - xi, dy = four(y, j) - yi, dz = four(z, j) - zi,
                   sum = four(radius, j) + ri;
      const Ints out = dx * dx + dy * dy + dz * dz > sum * sum;
      std::memcpy(apart.data() + j, &out, sizeof out);
    }
  }

  /// Whether the ball of item j is apart from the box of item i in the frame of i.
  [[nodiscard]] bool is_beside_box(std::size_t i, std::size_t j) const {
    // Within radius[j] of the place y of the ball: |p − L⁻¹y| ≤ (1 + D) radius for points p of the
    // box, and |Lᵀy − L⁻¹y| ≤ 2 D |y|.
    const Vec3 between = Vec3(x[j], y[j], z[j]) - poses[i].translation;
    const Vec3 p = poses[i].linear.transpose() * between;
    const geom::Box3& box = sets[i].set().box();
    const Vec3 apart = (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0);
    const double reach = (radius[j] + errors[i]) * (1 + 1e-8) + 1e-8 * between.lpNorm<1>();
    return apart.squaredNorm() > reach * reach;
  }
};

}  // namespace kaboum::world
