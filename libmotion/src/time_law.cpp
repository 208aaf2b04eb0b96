// Speed along a path with limits of velocity, acceleration and jerk: passes forward and backward
// over its pieces, and a double-S on each.

#include "time_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kaboum::motion {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kHalvings = 100;    ///< of an interval in which a speed is looked for
constexpr int kTried = 8;         ///< speeds of which the fastest is taken
constexpr int kImprovements = 3;  ///< of all speeds at the ends of pieces

/// What of a joint bounds the speed along a piece.
struct JointBound {
  double first = 0, second = 0, third = 0;          ///< of the curve, at most
  double velocity = 0, acceleration = 0, jerk = 0;  ///< allowed
};

/// From one speed to another one: the acceleration grows, stays and falls. Without any if both are
/// alike; of endless time if they cannot be.
struct Ramp {
  double from = 0, to = 0, rise = 0, hold = 0, jerk = 0;

  [[nodiscard]] double time() const { return 2 * rise + hold; }
  [[nodiscard]] double distance() const { return 0.5 * (from + to) * time(); }
};

/// The limits of the parameter on a piece: the faster it is, the less it may be accelerated.
class SpeedBound {
 public:
  SpeedBound(const PathPiece& piece, const SpeedLimits& limits)
      : length_(piece.length), bent_(piece.is_blend) {
    for (std::size_t j = 0; j < piece.in.size(); ++j) {
      const double turn = bent_ ? std::abs(piece.out[j] - piece.in[j]) : 0;
      const JointBound b{std::max(std::abs(piece.in[j]), std::abs(piece.out[j])),
                         1.5 * turn / length_,
                         6 * turn / (length_ * length_),
                         limits.velocity[j],
                         limits.acceleration[j],
                         limits.jerk[j]};
      if (b.first == 0) continue;
      top_ = std::min(top_, b.velocity / b.first);
      if (b.second > 0) top_ = std::min(top_, std::sqrt(b.acceleration / b.second));
      if (b.third > 0) top_ = std::min(top_, std::cbrt(b.jerk / b.third));
      joints_.push_back(b);
    }
  }

  [[nodiscard]] double top() const { return top_; }

  /// @pre both speeds are from 0 to top()
  [[nodiscard]] Ramp ramp(double from, double to) const {
    const double change = std::abs(to - from), speed = std::max(from, to);
    if (change == 0) return {from, to};
    double most = kInfinite, jerk = kInfinite;
    for (const JointBound& b : joints_) {
      // |q̈| ≤ second·ṡ² + first·|s̈|; of |q⃛| ≤ third·ṡ³ + 3·second·ṡ·|s̈| + first·|s⃛| what the
      // first term leaves is halved between the others.
      const double left = std::max(0.0, b.jerk - b.third * speed * speed * speed);
      most = std::min(most, std::max(0.0, b.acceleration - b.second * speed * speed) / b.first);
      if (b.second > 0) most = std::min(most, left / (6 * b.second * speed));
      jerk = std::min(jerk, (b.second > 0 ? 0.5 : 1) * left / b.first);
    }
    if (most == 0 || jerk == 0) return {from, to, kInfinite, 0, 0};
    const bool holds = change * jerk > most * most;
    const double rise = holds ? most / jerk : std::sqrt(change / jerk);
    return {from, to, rise, holds ? change / most - rise : 0, jerk};
  }

  [[nodiscard]] bool fits(double from, double to) const {
    return ramp(from, to).distance() <= length_;
  }
  /// The largest speed at the other end of the piece, not below this one's.
  [[nodiscard]] double reach(double from) const {
    return largest(from, top_, [&](double to) { return fits(from, to); });
  }
  /// The speed between that makes the piece shortest in time.
  [[nodiscard]] double best_between(double from, double to) const {
    const double low = std::max(from, to);
    const double high = largest(low, top_, [&](double peak) {
      return ramp(from, peak).distance() + ramp(peak, to).distance() <= length_;
    });
    if (!bent_) return high;  // the limits do not depend on the speed
    double best = low, least = time(from, low, to);
    for (int k = 1; k <= kTried; ++k) {
      const double peak = k == kTried ? high : low + (high - low) * k / kTried;
      const double needed = time(from, peak, to);
      if (needed < least) {
        least = needed;
        best = peak;
      }
    }
    return best;
  }
  [[nodiscard]] double time(double from, double peak, double to) const {
    const Ramp up = ramp(from, peak), down = ramp(peak, to);
    const double rest = length_ - up.distance() - down.distance();
    if (!(rest >= 0) || !(peak > 0)) return kInfinite;
    return up.time() + rest / peak + down.time();
  }
  [[nodiscard]] double least_time(double from, double to) const {
    if (!fits(from, to)) return kInfinite;
    return time(from, best_between(from, to), to);
  }

 private:
  template <class Allowed>
  static double largest(double low, double high, Allowed allowed) {
    if (low >= high) return low;
    if (allowed(high)) return high;
    // Of what size it is.
    for (double next = high * 0x1p-20; next > low; next *= 0x1p-20)
      (allowed(next) ? low : high) = next;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (allowed(middle) ? low : high) = middle;
    }
    return low;
  }

  double length_;
  bool bent_;
  double top_ = kInfinite;
  std::vector<JointBound> joints_;
};

/// Speeds at the ends of pieces: as large as what is before and after allows, then each such that
/// the two pieces that meet there take least time.
std::vector<double> speeds_at_ends(const std::vector<SpeedBound>& bounds) {
  const std::size_t count = bounds.size();
  std::vector<double> speed(count + 1, 0);
  for (std::size_t i = 1; i < count; ++i)
    speed[i] = std::min(bounds[i - 1].reach(speed[i - 1]), bounds[i].top());
  for (std::size_t i = count - 1; i > 0; --i)
    speed[i] = std::min(speed[i], bounds[i].reach(speed[i + 1]));
  for (int round = 0; round < kImprovements; ++round)
    for (std::size_t i = 1; i < count; ++i) {
      const SpeedBound &before = bounds[i - 1], &after = bounds[i];
      const auto needed = [&](double x) {
        return before.least_time(speed[i - 1], x) + after.least_time(x, speed[i + 1]);
      };
      const double most =
          std::min({before.top(), after.top(), std::max(speed[i - 1], before.reach(speed[i - 1])),
                    std::max(speed[i + 1], after.reach(speed[i + 1]))});
      double best = speed[i], least = needed(best);
      for (int k = 1; k <= 2 * kTried; ++k) {
        const double x = most * k / (2 * kTried);
        const double time = needed(x);
        if (time < least) {
          least = time;
          best = x;
        }
      }
      speed[i] = best;
    }
  return speed;
}

}  // namespace

TimeLaw::TimeLaw(std::span<const PathPiece> pieces, const SpeedLimits& limits) {
  std::vector<SpeedBound> bounds;
  bounds.reserve(pieces.size());
  for (const PathPiece& piece : pieces) bounds.emplace_back(piece, limits);
  if (bounds.empty()) return;
  const std::vector<double> speed = speeds_at_ends(bounds);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    begins_.push_back(duration_);
    lengths_.push_back(pieces[i].length);
    const double peak = bounds[i].best_between(speed[i], speed[i + 1]);
    const Ramp up = bounds[i].ramp(speed[i], peak), down = bounds[i].ramp(peak, speed[i + 1]);
    JerkPhase now{i, duration_, 0, speed[i], 0, 0};
    const auto pass = [&](double time, double jerk) {
      if (!(time > 0)) return;
      now.jerk = jerk;
      phases_.push_back(now);
      now.place += time * (now.speed + time * (now.acceleration / 2 + time * jerk / 6));
      now.speed += time * (now.acceleration + time * jerk / 2);
      now.acceleration += time * jerk;
      now.time += time;
    };
    const auto follow = [&](const Ramp& ramp) {
      const double jerk = ramp.to > ramp.from ? ramp.jerk : -ramp.jerk;
      pass(ramp.rise, jerk);
      pass(ramp.hold, 0);
      pass(ramp.rise, -jerk);
      now.speed = ramp.to;
      now.acceleration = 0;
    };
    follow(up);
    pass((pieces[i].length - up.distance() - down.distance()) / peak, 0);
    follow(down);
    duration_ = now.time;
  }
}

Progress TimeLaw::at(double time) const {
  auto phase = std::upper_bound(phases_.begin(), phases_.end(), time,
                                [](double t, const JerkPhase& p) { return t < p.time; });
  if (phase != phases_.begin()) --phase;
  const double t = std::max(0.0, time - phase->time);
  return {phase->piece,
          std::clamp(phase->place +
                         t * (phase->speed + t * (phase->acceleration / 2 + t * phase->jerk / 6)),
                     0.0, lengths_[phase->piece]),
          std::max(0.0, phase->speed + t * (phase->acceleration + t * phase->jerk / 2)),
          phase->acceleration + t * phase->jerk};
}

}  // namespace kaboum::motion
