// Configurations, paths and sequences of actions by trying.
#include "brute_force.h"

#include <kaboum/judge/placement.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using judge::CellState;

constexpr int kStarts = 40, kSteps = 40;
constexpr double kExact = 1e-9, kInside = 1e-6, kSame = 1e-4;
constexpr double kBackOff = 0.06;  // [m]
constexpr int kDetours = 6, kTurns = 16;
constexpr double kAbove = 0.003;  // where blocks are put down [m]

Transform inverse(const Transform& t) {
  return {t.linear.transpose(), -(t.linear.transpose() * t.translation)};
}

/// Poses of a chain's links in the world; link 0 is its root.
std::vector<Transform> poses_of(const world::RobotModel& model, const std::vector<double>& q) {
  std::vector<Transform> out = {model.base};
  for (std::size_t j = 0; j < q.size(); ++j) {
    const robot::Joint& joint = model.kinematics.joints[j];
    const Transform& at = out.back();
    out.push_back(
        {at.linear * joint.origin.linear * Eigen::AngleAxisd(q[j], joint.axis).toRotationMatrix(),
         at.linear * joint.origin.translation + at.translation});
  }
  return out;
}

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

}  // namespace

std::optional<std::vector<double>> BruteForce::newton(std::size_t robot, const Transform& target,
                                                      std::vector<double> q) const {
  const world::RobotModel& model = scene_.world.robots[robot];
  const std::size_t n = q.size();
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Transform> at = poses_of(model, q);
    const Transform& hand = at[scene_.hand];
    const Eigen::AngleAxisd turn(target.linear * hand.linear.transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << target.translation - hand.translation, turn.angle() * turn.axis();
    if (error.norm() < kExact) {
      for (std::size_t j = 0; j < n; ++j) {
        const robot::Variable& v = model.kinematics.variables[j];
        q[j] = std::remainder(q[j], 2 * std::numbers::pi);
        if (q[j] < *v.lower + kInside || q[j] > *v.upper - kInside) return std::nullopt;
      }
      return q;
    }
    Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> jacobian(6, n);
    for (std::size_t j = 0; j < n; ++j) {
      const robot::Joint& joint = model.kinematics.joints[j];
      const Transform& link = at[j + 1];
      const Vec3 axis = link.linear * joint.axis;
      jacobian.col(static_cast<Eigen::Index>(j)) << axis.cross(hand.translation - link.translation),
          axis;
    }
    const double damping = std::min(1e-2, 1e-2 * error.squaredNorm());
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> square =
        jacobian.transpose() * jacobian +
        damping *
            Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> move =
        square.ldlt().solve(jacobian.transpose() * error);
    if (!move.allFinite()) return std::nullopt;
    move *= std::min(1.0, 0.7 / move.cwiseAbs().maxCoeff());
    for (std::size_t j = 0; j < n; ++j) q[j] += move[static_cast<Eigen::Index>(j)];
  }
  return std::nullopt;
}

std::vector<std::vector<double>> BruteForce::configurations(std::size_t robot,
                                                            const Transform& target) const {
  const world::RobotModel& model = scene_.world.robots[robot];
  std::vector<std::vector<double>> out;
  // Nothing reaches farther than the links are long together.
  double longest = 0;
  for (const robot::Joint& joint : model.kinematics.joints)
    longest += joint.origin.translation.norm();
  if ((target.translation - model.base.translation).norm() > longest) return out;
  std::mt19937 random(7);
  for (int k = 0; k < kStarts; ++k) {
    std::vector<double> q;
    for (const robot::Variable& v : model.kinematics.variables)
      q.push_back(uniform(random, *v.lower, *v.upper));
    const auto found = newton(robot, target, std::move(q));
    if (!found) continue;
    const bool known = std::ranges::any_of(out, [&](const std::vector<double>& other) {
      for (std::size_t j = 0; j < other.size(); ++j)
        if (std::abs(other[j] - (*found)[j]) > kSame) return false;
      return true;
    });
    if (!known) out.push_back(*found);
  }
  return out;
}

judge::Hold BruteForce::hold(std::size_t robot, std::size_t block, std::size_t grasp) const {
  return {robot, scene_.hand, judge::product(scene_.tool, scene_.blocks[block].grasps[grasp]), {}};
}

std::vector<BruteForce::Reach> BruteForce::free_reaches(const CellState& state, std::size_t robot,
                                                        std::size_t block, bool every) const {
  std::vector<Reach> out;
  const RandomScene::Block& b = scene_.blocks[block];
  const Transform pose = scene_.cell.pose_of(state, b.object);
  for (std::size_t g = 0; g < b.grasps.size(); ++g)
    for (std::vector<double>& q :
         configurations(robot, judge::product(pose, inverse(hold(robot, block, g).pose)))) {
      CellState there = state;
      there.q[robot] = q;
      if (!is_free(there, robot)) continue;
      there.objects[b.object].hold = hold(robot, block, g);
      if (!is_free(there, robot)) continue;
      out.push_back({g, std::move(q)});
      if (!every) return out;
    }
  return out;
}

bool BruteForce::is_free_along(CellState state, std::size_t robot, const Path& path,
                               double step) const {
  for (std::size_t s = 0; s + 1 < path.size(); ++s) {
    double most = 0;
    for (std::size_t j = 0; j < path[s].size(); ++j)
      most = std::max(most, std::abs(path[s + 1][j] - path[s][j]));
    const int count = std::max(1, static_cast<int>(std::ceil(most / step)));
    for (int i = count; i >= 0; --i) {
      for (std::size_t j = 0; j < path[s].size(); ++j)
        state.q[robot][j] = path[s][j] + (path[s + 1][j] - path[s][j]) * i / count;
      if (!is_free(state, robot)) return false;
    }
  }
  return true;
}

std::vector<BruteForce::Path> BruteForce::ways(std::size_t robot,
                                               const std::vector<double>& q) const {
  const world::RobotModel& model = scene_.world.robots[robot];
  std::vector<Path> ends = {{q}};
  Transform back = poses_of(model, q)[scene_.hand];
  back.translation -= kBackOff * back.linear.col(2);
  if (const auto off = newton(robot, back, q)) {
    bool near = true;
    for (std::size_t j = 0; j < q.size(); ++j) near = near && std::abs((*off)[j] - q[j]) < 0.7;
    if (near) ends.push_back({*off, q});
  }
  std::vector<Path> out;
  std::mt19937 random(11);
  for (int k = 0; k <= kDetours; ++k) {
    Path begin = {model.home};
    if (k > 0) {
      std::vector<double> detour;
      for (const robot::Variable& v : model.kinematics.variables)
        detour.push_back(uniform(random, 0.7 * *v.lower, 0.7 * *v.upper));
      begin.push_back(std::move(detour));
    }
    for (const Path& end : ends) {
      out.push_back(begin);
      out.back().insert(out.back().end(), end.begin(), end.end());
    }
  }
  return out;
}

bool BruteForce::search(const CellState& state, std::vector<bool> removed, std::vector<bool> stowed,
                        double step, int depth) const {
  const auto met = [](const std::vector<std::size_t>& wanted, const std::vector<bool>& done) {
    return std::ranges::all_of(wanted, [&](std::size_t b) { return done[b]; });
  };
  if (met(scene_.removed, removed) && met(scene_.stowed, stowed)) return true;
  if (depth == 0) return false;
  const auto wanted = [&](const std::vector<std::size_t>& list, std::size_t b) {
    return std::ranges::find(list, b) != list.end();
  };
  for (std::size_t b = 0; b < scene_.blocks.size(); ++b) {
    const std::size_t object = scene_.blocks[b].object;
    if (state.objects[object].away || stowed[b]) continue;
    for (std::size_t r = 0; r < scene_.world.robots.size(); ++r) {
      bool taken = false;
      for (const Reach& reach : free_reaches(state, r, b, true)) {
        CellState held = state;
        held.objects[object].hold = hold(r, b, reach.grasp);
        const auto there = ways(r, reach.q);
        if (std::ranges::none_of(there,
                                 [&](const Path& p) { return is_free_along(state, r, p, step); }) ||
            std::ranges::none_of(there,
                                 [&](const Path& p) { return is_free_along(held, r, p, step); }))
          continue;
        if (!taken && !wanted(scene_.stowed, b)) {
          CellState next = state;
          next.objects[object].away = true;
          std::vector<bool> more = removed;
          more[b] = true;
          if (search(next, more, stowed, step, depth - 1)) return true;
          taken = true;
        }
        if (!scene_.shelf || !wanted(scene_.stowed, b)) continue;
        for (int k = 0; k < kTurns; ++k) {
          Transform pose;
          pose.linear = Eigen::AngleAxisd(2 * std::numbers::pi * k / kTurns, Vec3::UnitZ())
                            .toRotationMatrix() *
                        scene_.world.objects[object].pose.linear;
          pose.translation = scene_.shelf_top + Vec3(0, 0, kAbove) +
                             pose.linear * Vec3(0, 0, scene_.blocks[b].half_height);
          for (const auto& q :
               configurations(r, judge::product(pose, inverse(held.objects[object].hold->pose)))) {
            CellState next = state;
            next.objects[object].pose = pose;
            if (scene_.grown.find_meeting_of(next, object)) continue;
            const auto ways_there = ways(r, q);
            if (std::ranges::none_of(
                    ways_there, [&](const Path& p) { return is_free_along(held, r, p, step); }) ||
                std::ranges::none_of(
                    ways_there, [&](const Path& p) { return is_free_along(next, r, p, step); }))
              continue;
            std::vector<bool> more = stowed;
            more[b] = true;
            if (search(next, removed, more, step, depth - 1)) return true;
          }
        }
      }
    }
  }
  return false;
}

bool BruteForce::has_solution(double step) const {
  const std::vector<bool> none(scene_.blocks.size(), false);
  return search(scene_.state(), none, none, step, static_cast<int>(scene_.blocks.size()));
}

}  // namespace kaboum::test
