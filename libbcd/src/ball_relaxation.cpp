// Balls that move until they hold given points: local search over their centres.
#include "ball_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kaboum::bcd {
namespace {

using geom::Vec3;

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr int kSteps = 4;                          ///< of a ball in a sweep, in random directions
constexpr int kConvexSteps = 6, kFailedSteps = 3;  ///< before them
constexpr std::size_t kLimits = 24;                ///< that a ball knows
constexpr double kMargin = 1e-3;   ///< of the square of the radius, by which points are to be held
constexpr double kLongest = 0.5;   ///< of the radius, of a step
constexpr int kPlaces = 30;        ///< tried for a ball that is put elsewhere
constexpr int kSweepsInVain = 10;  ///< before one is
/// Points this share of a ball's radius beyond it count as near.
constexpr double kNear = 0.6;
/// Steps, as shares of the radius: the first, the shortest, the longest at the start of a sweep.
constexpr double kFirstStep = 0.1, kShortestStep = 1e-3, kAgain = 0.02;
constexpr double kLonger = 1.5, kShorter = 0.8;
/// Work of a radius, and of a point and a ball. [ns]
constexpr double kRadiusWork = 15e3, kPairWork = 3;

}  // namespace

BallRelaxation::BallRelaxation(RoomAbout room_about, const std::vector<Vec3>& points, double spare,
                               std::uint64_t seed)
    : room_about_(std::move(room_about)), points_(points), spare_(spare), random_(seed) {}

void BallRelaxation::begin(const std::vector<Ball>& balls) {
  balls_ = balls;
  weight_.assign(points_.size(), 1);
  step_.clear();
  for (const Ball& b : balls) step_.push_back(kFirstStep * b.radius);
  limits_.assign(balls.size(), {});
}

Ball BallRelaxation::ball_at(const Vec3& c) {
  work_ += kRadiusWork;
  const ParallelBody::Room room = room_about_(c);
  limit_found_ = room.limit;
  return {c, room.radius};
}

/// Whether a ball other than `ball`, of those in near_, holds a point. The one that held it before
/// is tried first: most often it still does.
bool BallRelaxation::is_held_by_other(std::uint32_t point, std::size_t ball) {
  const Vec3& at = points_[point];
  const std::uint32_t before = holder_[point];
  if (before < balls_.size() && before != ball && holds(balls_[before], at)) return true;
  for (const std::uint32_t b : near_)
    if (holds(balls_[b], at)) {
      holder_[point] = b;
      return true;
    }
  return false;
}

/// Points within `reach` of a place that balls other than this one leave.
void BallRelaxation::ask(std::size_t ball, const Vec3& about, double reach) {
  asked_.clear();
  near_.clear();
  holder_.resize(points_.size(), 0);
  work_ += kPairWork * static_cast<double>(points_.size());
  for (std::uint32_t b = 0; b < balls_.size(); ++b)
    if (b != ball && is_near(balls_[b], about, reach)) near_.push_back(b);
  const double square = reach * reach;
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    const Vec3& at = points_[p];
    if ((at - about).squaredNorm() > square) continue;
    work_ += kPairWork * static_cast<double>(near_.size());
    if (is_held_by_other(p, ball)) continue;
    double other = kFar;
    for (const std::uint32_t b : near_) other = std::min(other, gap(balls_[b], at));
    if (other > 0) asked_.push_back({p, other});
  }
}

double BallRelaxation::cost(const Ball& ball) {
  double out = 0;
  work_ += kPairWork * static_cast<double>(asked_.size());
  for (const Asked& a : asked_) {
    const double left = std::min(a.other, gap(ball, points_[a.point]));
    if (left > 0) out += weight_[a.point] * left * left;
  }
  return out;
}

Vec3 BallRelaxation::direction() {
  for (;;) {
    const double x = random_.between(-1, 1), y = random_.between(-1, 1), z = random_.between(-1, 1);
    const double square = x * x + y * y + z * z;
    if (square > 0.01 && square <= 1) return Vec3(x, y, z) / std::sqrt(square);
  }
}

/// The centre of the ball that has the limits outside and leaves the least sum of the weighted
/// squares of powers of what is asked, nearly.
Vec3 BallRelaxation::convex_step(const Ball& now, const std::vector<Vec3>& limits) {
  constexpr int kTurns = 12, kHalvings = 5;
  constexpr double kFirm = 30;  // weight of limits beside all points
  using Vec4 = Eigen::Vector4d;
  // Powers are row · (c, |c|² − r²) + square, in units of the radius from the centre.
  struct Row {
    Vec4 row;
    double square, weight;
  };
  const double unit = 1 / now.radius, margin = 2 * spare_ + kMargin;
  double sum = 0;
  std::vector<Row> rows;
  const auto add = [&](const Vec3& p, double sign, double more, double weight) {
    const Vec3 y = unit * (p - now.center);
    Vec4 row;
    row << -2 * sign * y, sign;
    rows.push_back({row, sign * y.squaredNorm() + more, weight});
  };
  for (const Asked& a : asked_) {
    if (a.other < gap(now, points_[a.point])) continue;  // rather another ball's
    add(points_[a.point], 1, margin, weight_[a.point]);
    sum += weight_[a.point];
  }
  for (const Vec3& b : limits) add(b, -1, 0, kFirm * sum);
  work_ += kPairWork * kTurns * static_cast<double>(rows.size());
  const auto value = [&](const Vec4& x) {
    double out = 0;
    for (const Row& r : rows) {
      const double f = r.row.dot(x) + r.square;
      if (f > 0) out += r.weight * f * f;
    }
    return out;
  };
  Vec4 x(0, 0, 0, -1);
  double least = value(x);
  for (int turn = 0; turn < kTurns && least > 0; ++turn) {
    Eigen::Matrix4d h = Eigen::Matrix4d::Zero();
    Vec4 g = Vec4::Zero();
    for (const Row& r : rows) {
      const double f = r.row.dot(x) + r.square;
      if (!(f > 0)) continue;
      h.noalias() += r.weight * r.row * r.row.transpose();
      g += r.weight * f * r.row;
    }
    h.diagonal().array() += 1e-6 * h.trace() + 1e-300;
    Vec4 step = -h.ldlt().solve(g);
    if (!step.allFinite()) break;
    bool is_better = false;
    for (int half = 0; half < kHalvings; ++half, step *= 0.5) {
      const double then = value(x + step);
      if (!(then < least * (1 - 1e-6))) continue;
      x += step;
      least = then;
      is_better = true;
      break;
    }
    if (!is_better) break;
  }
  Vec3 way = x.head<3>() * now.radius;
  if (const double length = way.norm(); length > kLongest * now.radius)
    way *= kLongest * now.radius / length;
  return now.center + way;
}

void BallRelaxation::move(std::size_t ball) {
  Ball& now = balls_[ball];
  ask(ball, now.center, (1 + kNear) * now.radius);
  double least = cost(now);
  std::vector<Vec3>& limits = limits_[ball];
  const auto learn = [&] {
    if (!limit_found_) return;
    if (limits.size() >= kLimits) limits.erase(limits.begin());
    limits.push_back(*limit_found_);
  };
  if (least > 0 && limits.empty()) {
    ball_at(now.center);
    learn();
  }
  int failed = 0;
  for (int turn = 0; turn < kConvexSteps && least > 0 && failed < kFailedSteps; ++turn) {
    const Vec3 at = convex_step(now, limits);
    if ((at - now.center).norm() < kShortestStep * now.radius) break;
    const Ball next = ball_at(at);
    learn();
    const double then = next.radius > 0 ? cost(next) : kFar;
    if (!(then < least)) {
      ++failed;
      continue;
    }
    least = then;
    now = next;
  }
  double step = std::max(step_[ball], kAgain * now.radius);
  for (int turn = 0; turn < kSteps && least > 0; ++turn) {
    const Vec3 along = step * direction();
    bool is_better = false;
    for (const double sign : {1.0, -1.0}) {
      const Ball next = ball_at(now.center + sign * along);
      if (!(next.radius > 0)) continue;
      const double then = cost(next);
      if (!(then < least)) continue;
      least = then;
      now = next;
      is_better = true;
      break;
    }
    step =
        std::clamp(step * (is_better ? kLonger : kShorter), kShortestStep * now.radius, now.radius);
  }
  step_[ball] = step;
}

/// The cost of leaving a ball out: how much farther from all balls the points would be that it
/// alone holds or is near to.
double BallRelaxation::loss_without(std::size_t ball) {
  const Ball& b = balls_[ball];
  ask(ball, b.center, (1 + kNear) * b.radius);
  double out = 0;
  for (const Asked& a : asked_) {
    const double own = std::max(0.0, gap(b, points_[a.point]));
    const double other = std::min(a.other, 2 * b.radius);
    if (own < other) out += weight_[a.point] * (other * other - own * own);
  }
  return out;
}

std::size_t BallRelaxation::least_needed() {
  std::size_t out = 0;
  double least = kFar;
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    const double loss = loss_without(b);
    if (loss < least) {
      least = loss;
      out = b;
    }
  }
  return out;
}

/// @return whether so many were left out before the work was done
bool BallRelaxation::leave_out(std::size_t count) {
  std::vector<double> losses(balls_.size());
  for (std::size_t b = 0; b < balls_.size() && work() < limit_; ++b) losses[b] = loss_without(b);
  for (std::size_t k = 0; k < count; ++k) {
    const auto b = std::ranges::min_element(losses) - losses.begin();
    const Ball gone = balls_[static_cast<std::size_t>(b)];
    balls_.erase(balls_.begin() + b);
    step_.erase(step_.begin() + b);
    limits_.erase(limits_.begin() + b);
    losses.erase(losses.begin() + b);
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      if (!(work() < limit_)) return false;
      if (is_near(gone, balls_[i].center, (1 + kNear) * balls_[i].radius))
        losses[i] = loss_without(i);
    }
  }
  return true;
}

void BallRelaxation::find_free() {
  free_.clear();
  work_ += 0.5 * kPairWork * static_cast<double>(points_.size() * balls_.size());
  holder_.resize(points_.size(), 0);
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    const Vec3& at = points_[p];
    if (holder_[p] < balls_.size() && holds(balls_[holder_[p]], at)) continue;
    const auto holder = std::ranges::find_if(balls_, [&](const Ball& b) { return holds(b, at); });
    if (holder == balls_.end())
      free_.push_back(p);
    else
      holder_[p] = static_cast<std::uint32_t>(holder - balls_.begin());
  }
}

/// Puts the ball that is needed least where a free point is.
void BallRelaxation::relocate() {
  double sum = 0;
  for (const std::uint32_t p : free_) sum += weight_[p];
  double rest = random_.between(0, sum);
  std::uint32_t point = free_.back();
  for (const std::uint32_t p : free_) {
    rest -= weight_[p];
    if (rest > 0) continue;
    point = p;
    break;
  }
  const std::size_t b = least_needed();
  const double reach = balls_[b].radius;
  const Vec3 at = points_[point];
  ask(b, at, 2 * reach);
  Ball best = ball_at(at);
  double least = cost(best);
  for (int k = 0; k < kPlaces; ++k) {
    const Ball next = ball_at(at + random_.between(0, reach) * direction());
    if (!(next.radius > 0)) continue;
    const double then = cost(next);
    if (!(then < least)) continue;
    least = then;
    best = next;
  }
  balls_[b] = best;
  limits_[b].clear();
  step_[b] = kFirstStep * best.radius;
}

bool BallRelaxation::hold(std::vector<Ball>& balls, int sweeps) {
  begin(balls);
  std::size_t fewest = points_.size() + 1;
  int in_vain = 0;
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    find_free();
    if (free_.empty()) {
      balls = balls_;
      return true;
    }
    if (sweep == sweeps || work() >= limit_) break;
    for (const std::uint32_t p : free_) weight_[p] += 1;
    if (free_.size() < fewest) {
      fewest = free_.size();
      in_vain = 0;
    } else if (++in_vain >= kSweepsInVain) {
      relocate();
      in_vain = 0;
      fewest = points_.size() + 1;
    }
    for (std::size_t b = 0; b < balls_.size() && work() < limit_; ++b) move(b);
  }
  return false;
}

bool BallRelaxation::hold_with_fewer(std::vector<Ball>& balls, std::size_t count, int sweeps) {
  begin(balls);
  if (!leave_out(count)) return false;
  std::vector<Ball> fewer = balls_;
  if (!hold(fewer, sweeps)) return false;
  balls = std::move(fewer);
  return true;
}

}  // namespace kaboum::bcd
