#pragma once

#include <kaboum/base/random.h>
#include <kaboum/bcd/balls.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "parallel_body.h"

namespace kaboum::bcd {

/// Search of places for a given number of balls that hold given points. One ball after the other
/// moves to where it leaves less of what the others leave: the sum of the squares of the points'
/// distances, with weights. Points that stay free gain weight. Now and then the ball that is needed
/// least is put to a free point.
///
/// The power |x − c|² − r² of a point x is linear in c and |c|² − r². So the ball that leaves the
/// least weighted squares of powers of some points, and has limits outside, is the solution of a
/// convex problem of four variables. Limits are points that were found to end a ball's radius near
/// the place.
class BallRelaxation {
 public:
  /// The radius that a ball about a point has, and what it ends at; ≤ 0: there is none. [length]
  using RoomAbout = std::function<ParallelBody::Room(const geom::Vec3&)>;

  /// @param points  referred to; may become more between calls
  /// @param spare  share of the radius by which points are to be held [1]
  BallRelaxation(RoomAbout room_about, const std::vector<geom::Vec3>& points, double spare,
                 std::uint64_t seed);

  /// Moves the balls until they hold all points.
  /// @param sweeps  so often every ball may move, while work() is below the limit
  /// @return whether they do; if not, the balls stay as they were
  bool hold(std::vector<Ball>& balls, int sweeps);

  /// The same with fewer balls: first without those that are needed least.
  /// @pre count < balls.size()
  bool hold_with_fewer(std::vector<Ball>& balls, std::size_t count, int sweeps);

  /// After which balls move no more. [s]
  void limit_work(double limit) { limit_ = limit; }
  /// No less than the time that all calls took on one core of a machine of 2020, by counting. [s]
  [[nodiscard]] double work() const { return 1e-9 * work_; }

 private:
  /// A point near a ball that no other ball holds.
  struct Asked {
    std::uint32_t point;
    double other;  ///< distance from the nearest other ball, above 0 [length]
  };

  void begin(const std::vector<Ball>& balls);
  [[nodiscard]] double gap(const Ball& ball, const geom::Vec3& p) const {
    return (p - ball.center).norm() - ball.radius * (1 - spare_);
  }
  [[nodiscard]] bool holds(const Ball& ball, const geom::Vec3& p) const {
    const double radius = ball.radius * (1 - spare_);
    return radius > 0 && (p - ball.center).squaredNorm() <= radius * radius;
  }
  [[nodiscard]] bool is_held_by_other(std::uint32_t point, std::size_t ball);
  /// True if a ball may hold a point within `reach` of a place, or be as near to one as that.
  [[nodiscard]] static bool is_near(const Ball& ball, const geom::Vec3& about, double reach) {
    return (ball.center - about).norm() < ball.radius + 2 * reach;
  }
  void ask(std::size_t ball, const geom::Vec3& about, double reach);
  [[nodiscard]] double cost(const Ball& ball);
  /// The ball about a place; sets limit_found_.
  Ball ball_at(const geom::Vec3& c);
  [[nodiscard]] geom::Vec3 convex_step(const Ball& now, const std::vector<geom::Vec3>& limits);
  [[nodiscard]] geom::Vec3 direction();
  void move(std::size_t ball);
  [[nodiscard]] double loss_without(std::size_t ball);
  [[nodiscard]] std::size_t least_needed();
  bool leave_out(std::size_t count);
  void find_free();
  void relocate();

  RoomAbout room_about_;
  const std::vector<geom::Vec3>& points_;
  double spare_;
  std::vector<Ball> balls_;
  std::vector<double> step_;                     ///< of each ball, the next one's length
  std::vector<std::vector<geom::Vec3>> limits_;  ///< of each ball, those found near it
  std::optional<geom::Vec3> limit_found_;        ///< by the last call of ball_at
  std::vector<double> weight_;                   ///< of each point
  std::vector<std::uint32_t> holder_;            ///< of each point, a ball that held it last
  std::vector<std::uint32_t> free_;              ///< points that no ball holds
  std::vector<Asked> asked_;                     ///< of one ball
  std::vector<std::uint32_t> near_;              ///< balls near it
  Random random_;
  double work_ = 0;  ///< [ns]
  double limit_ = std::numeric_limits<double>::infinity();
};

}  // namespace kaboum::bcd
