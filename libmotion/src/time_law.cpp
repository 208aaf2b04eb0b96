// Motions along paths with limits of velocity, acceleration and jerk: means over time of motions
// that keep the first two.

#include "time_law.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "speed_profile.h"

namespace kaboum::motion {
namespace {

using Values = std::vector<double>;

/// Least and greatest acceleration of a joint. Within a cell it is monotone.
struct Range {
  double low = 0, high = 0;
};

/// Of each joint in each cell, joint by joint.
class Accelerations {
 public:
  explicit Accelerations(const SpeedProfile& profile)
      : joints_(profile.cells.front().in.size()), times_(profile.times) {
    for (std::size_t i = 0; i < profile.cells.size(); ++i) {
      const PathCell& cell = profile.cells[i];
      const double along = profile.acceleration(i);
      for (std::size_t j = 0; j < joints_; ++j) {
        const double a = cell.bend[j] * profile.squares[i] + cell.in[j] * along,
                     b = cell.bend[j] * profile.squares[i + 1] + cell.out[j] * along;
        ranges_.push_back({std::min(a, b), std::max(a, b)});
      }
    }
  }
  [[nodiscard]] std::size_t cells() const { return times_.size() - 1; }
  [[nodiscard]] const Range& of(std::size_t cell, std::size_t joint) const {
    return ranges_[cell * joints_ + joint];
  }
  /// How much an acceleration changes within the span at most, by what it may: for the times in
  /// each cell at the span's end, and in the rest after them.
  [[nodiscard]] std::vector<double> changes(double span, const Values& allowed) const {
    std::vector<double> out;
    std::size_t first = 0;
    for (std::size_t i = 0; i <= cells(); ++i) {
      const double begin = times_[i] - span,
                   end = i < cells() ? times_[i + 1] - span : times_.back();
      while (first < cells() && times_[first + 1] <= begin) ++first;
      double most = begin < 0 ? change(nullptr, at(i), allowed) : 0;
      for (std::size_t k = first; k < cells() && k <= i && times_[k] < end; ++k)
        most = std::max(most, change(at(k), at(i), allowed));
      out.push_back(most);
    }
    return out;
  }

 private:
  [[nodiscard]] const Range* at(std::size_t cell) const {
    return cell < cells() ? &ranges_[cell * joints_] : nullptr;
  }
  [[nodiscard]] double change(const Range* a, const Range* b, const Values& allowed) const {
    constexpr Range rest{};
    double out = 0;
    for (std::size_t j = 0; j < joints_; ++j) {
      const Range &x = a != nullptr ? a[j] : rest, &y = b != nullptr ? b[j] : rest;
      out = std::max(out, std::max(y.high - x.low, x.high - y.low) / allowed[j]);
    }
    return out;
  }

  std::size_t joints_;
  const std::vector<double>& times_;
  std::vector<Range> ranges_;
};

Values scaled(Values values, double factor) {
  for (double& x : values) x *= factor;
  return values;
}

/// A profile, of which the mean over a span keeps all limits if it is slower by a factor.
struct Candidate {
  SpeedProfile profile;
  double span = 0, slower = 1, duration = std::numeric_limits<double>::infinity();
};

/// Looks for the fastest mean.
class Search {
 public:
  Search(std::span<const PathPiece> pieces, const SpeedLimits& limits)
      : pieces_(pieces), limits_(limits) {
    for (const PathPiece& piece : pieces)
      for (std::size_t j = 0; j < limits.jerk.size(); ++j)
        if (piece.in[j] != 0 || piece.out[j] != 0)
          usual_ = std::max(usual_, limits.acceleration[j] / limits.jerk[j]);
  }

  /// The piece that no speed was small enough for; nullopt: none was found.
  [[nodiscard]] std::optional<std::size_t> stuck() const { return stuck_; }

  Candidate run() {
    constexpr int kMostTurns = 8;
    for (int turn = 0; turn < kMostTurns && !std::isfinite(best_.duration); ++turn) {
      if (pieces_.size() == 1 && !pieces_.front().is_blend)
        run_straight();
      else
        run_bent();
      if (!(needed_ > usual_)) break;
      usual_ = 4 * needed_;  // jerks are smaller than they may be then
    }
    return std::move(best_);
  }

 private:
  /// Accelerations of which the change by all of them is allowed in a span.
  [[nodiscard]] Values accelerations(double span) const {
    Values out = limits_.acceleration;
    for (std::size_t j = 0; j < out.size(); ++j) out[j] = std::min(out[j], limits_.jerk[j] * span);
    return out;
  }

  /// @return how much accelerations change within the span, by what they may: of each cell, and
  ///   behind the last one
  std::vector<double> consider(const SpeedProfile& profile, double span) {
    const Accelerations accelerations(profile);
    double velocity = 0, acceleration = 0;
    for (std::size_t i = 0; i < profile.cells.size(); ++i) {
      const double speed = std::sqrt(std::max(profile.squares[i], profile.squares[i + 1]));
      for (std::size_t j = 0; j < limits_.velocity.size(); ++j) {
        const PathCell& cell = profile.cells[i];
        velocity = std::max(velocity, std::max(std::abs(cell.in[j]), std::abs(cell.out[j])) *
                                          speed / limits_.velocity[j]);
        const Range& range = accelerations.of(i, j);
        acceleration =
            std::max(acceleration, std::max(-range.low, range.high) / limits_.acceleration[j]);
      }
    }
    std::vector<double> changes = accelerations.changes(span, scaled(limits_.jerk, span));
    const double jerk = *std::ranges::max_element(changes),
                 slower = std::max({1.0, velocity, std::sqrt(acceleration), std::cbrt(jerk)}),
                 duration = slower * (profile.times.back() + span);
    const double least = kLeastSpan * profile.times.back();
    if (span < least)
      needed_ = std::max(needed_, least);
    else if (duration < best_.duration)
      best_ = {profile, span, slower, duration};
    return changes;
  }

  /// Calls with spans, in steps by a factor, until it is not faster for some of them.
  template <class Try>
  void try_shorter(double factor, int patience, Try attempt) {
    constexpr double kShortest = 0x1p-20;
    int vain = 0;
    for (double share = 1; share > kShortest && vain < patience; share *= factor) {
      const double before = best_.duration;
      attempt(share * usual_);
      vain = best_.duration < before ? 0 : vain + 1;
    }
  }

  void run_straight() {
    try_shorter(0.96, 12, [&](double span) {
      // It keeps its speed for a little longer than the span, whatever the roundings.
      consider(straight_profile(pieces_.front(), limits_.velocity, accelerations(span),
                                span * (1 + 0x1p-30)),
               span);
    });
  }

  void run_bent() {
    constexpr double kStep = 0.84;
    try_shorter(kStep, 3, [&](double span) { run_bent(span); });
    // In twice the span accelerations may be reversed.
    for (const double share : {1.2, 1.4, 1.7, 2.0}) run_bent(share * usual_);
  }

  void run_bent(double span);
  /// Squares of speeds that are not to be exceeded, so that accelerations change less.
  static void even_out(const SpeedProfile& profile, const std::vector<double>& changes, double span,
                       std::vector<double>& most);

  /// Of the time: a mean over less is rounded by more than is spared for it.
  static constexpr double kLeastSpan = 0x1p-20;

  std::span<const PathPiece> pieces_;
  const SpeedLimits& limits_;
  double usual_ = 0;   ///< span in which all accelerations may change by all of them
  double needed_ = 0;  ///< span that one tried should have had
  std::optional<std::size_t> stuck_;
  Candidate best_;
};

void Search::even_out(const SpeedProfile& profile, const std::vector<double>& changes, double span,
                      std::vector<double>& most) {
  const auto& times = profile.times;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!(changes[i] > 1)) continue;
    std::size_t last = i;  // of those too large
    while (last + 1 < changes.size() && changes[last + 1] > 1) ++last;
    const double end = last + 1 < times.size() ? times[last + 1] : times.back() + span,
                 middle = 0.5 * (times[i] + end) - 0.5 * span;
    const auto inside = [&](std::size_t k) { return std::abs(times[k] - middle) <= 0.55 * span; };
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k + 1 < times.size(); ++k)
      if (inside(k)) least = std::min(least, profile.squares[k]);
    for (std::size_t k = 1; k + 1 < times.size(); ++k)
      if (inside(k)) most[k] = std::min(most[k], least);
    i = last;
  }
}

void Search::run_bent(double span) {
  const Values most = accelerations(span);
  const SpeedProfile rough = fastest_profile(graded_cells(pieces_), limits_.velocity, most, {});
  if (!std::isfinite(rough.times.back())) {
    const auto never =
        std::ranges::find_if_not(rough.times, [](double t) { return std::isfinite(t); });
    stuck_ = rough.cells[static_cast<std::size_t>(never - rough.times.begin()) - 1].piece;
    return;
  }
  const double wished = std::clamp(4 * rough.times.back() / span, 64.0, 320.0);
  std::vector<PathCell> cells =
      even_cells(pieces_, rough, static_cast<std::size_t>(wished) + 4 * pieces_.size());
  std::vector<double> squares(cells.size() + 1, std::numeric_limits<double>::infinity());
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    const SpeedProfile profile = fastest_profile(cells, limits_.velocity, most, squares);
    if (!std::isfinite(profile.times.back())) return;
    const std::vector<double> changes = consider(profile, span);
    if (std::ranges::max(changes) <= 1 + 1e-9) break;
    even_out(profile, changes, span, squares);
  }
}

}  // namespace

TimeLaw::TimeLaw(std::span<const PathPiece> pieces, const SpeedLimits& limits)
    : pieces_(pieces.begin(), pieces.end()) {
  Search search(pieces, limits);
  const Candidate best = search.run();
  if (!std::isfinite(best.duration)) {
    const std::size_t at = pieces[search.stuck().value_or(0)].waypoint;
    throw Error(ErrorCode::LimitReached, "no speed is small enough at waypoint " +
                                             std::to_string(at + 1) +
                                             " of the path: leave out «blend», or that waypoint");
  }
  span_ = best.span;
  slower_ = best.slower;
  set(best.profile);
}

void TimeLaw::set(const SpeedProfile& profile) {
  for (std::size_t i = 0; i < profile.cells.size(); ++i) {
    const PathCell& cell = profile.cells[i];
    stretches_.push_back({cell.piece, profile.times[i], cell.place, std::sqrt(profile.squares[i]),
                          profile.acceleration(i), pieces_[cell.piece].at(cell.place).q, cell.in,
                          cell.bend});
  }
  time_ = profile.times.back();
}

std::size_t TimeLaw::stretch_at(double time) const {
  const auto next = std::ranges::upper_bound(stretches_, time, {}, &Stretch::begin);
  return next == stretches_.begin() ? 0 : static_cast<std::size_t>(next - stretches_.begin()) - 1;
}

/// Of the motion of which this is the mean. Before it and behind it stands.
Instant TimeLaw::moving_at(double time) const {
  const Stretch& s = stretches_[stretch_at(time)];
  const double t = std::clamp(time, 0.0, time_) - s.begin,
               along = t * (s.speed + 0.5 * t * s.acceleration),
               speed = s.speed + t * s.acceleration;
  const bool moves = time >= 0 && time <= time_;
  Instant out{s.q, Values(s.q.size(), 0), Values(s.q.size(), 0)};
  for (std::size_t j = 0; j < out.q.size(); ++j) {
    out.q[j] += along * (s.in[j] + 0.5 * along * s.bend[j]);
    if (!moves) continue;
    out.velocity[j] = speed * (s.in[j] + along * s.bend[j]);
    out.acceleration[j] =
        s.bend[j] * speed * speed + (s.in[j] + along * s.bend[j]) * s.acceleration;
  }
  return out;
}

Instant TimeLaw::at(double time) const {
  if (const auto straight = straight_at(time)) {
    const CurvePoint point = pieces_[straight->piece].at(straight->place);
    return {point.q, scaled(point.first, straight->speed),
            scaled(point.first, straight->acceleration)};
  }
  const double end = time / slower_, begin = end - span_;
  const Instant a = moving_at(begin), b = moving_at(end);
  const std::size_t first = stretch_at(begin), last = stretch_at(end);
  Values low = a.q, high = a.q, sum(a.q.size(), 0);
  // As far as it is from a, times how long it is there; at rest before the beginning it is a.
  for (std::size_t i = first; i <= last; ++i) {
    const Stretch& s = stretches_[i];
    const double from = std::max(begin, s.begin) - s.begin,
                 to = std::clamp(end, s.begin, end_of(i)) - s.begin, time_here = to - from;
    // Integrals of the parameter and of its square.
    const auto once = [&](double t) { return t * t * (s.speed / 2 + t * s.acceleration / 6); };
    const auto twice = [&](double t) {
      return t * t * t *
             (s.speed * s.speed / 3 + t * s.acceleration * (s.speed / 4 + t * s.acceleration / 20));
    };
    const double along = once(to) - once(from), squared = twice(to) - twice(from);
    const PathPiece& piece = pieces_[s.piece];
    for (std::size_t j = 0; j < sum.size(); ++j) {
      sum[j] += (s.q[j] - a.q[j]) * time_here + s.in[j] * along + 0.5 * s.bend[j] * squared;
      low[j] = std::min(low[j], piece.low[j]);
      high[j] = std::max(high[j], piece.high[j]);
    }
  }
  Instant out = b;
  const double after = std::max(0.0, end - std::max(time_, begin));
  for (std::size_t j = 0; j < out.q.size(); ++j) {
    sum[j] += (b.q[j] - a.q[j]) * after;
    out.q[j] = std::clamp(a.q[j] + sum[j] / span_, low[j], high[j]);
    out.velocity[j] = (b.q[j] - a.q[j]) / (span_ * slower_);
    out.acceleration[j] = (b.velocity[j] - a.velocity[j]) / (span_ * slower_ * slower_);
  }
  return out;
}

std::optional<Progress> TimeLaw::straight_at(double time) const {
  const double end = time / slower_, begin = end - span_;
  const std::size_t first = stretch_at(begin), last = stretch_at(end),
                    piece = stretches_[first].piece;
  if (pieces_[piece].is_blend || stretches_[last].piece != piece) return std::nullopt;
  const auto moving = [&](double at) {
    const Stretch& s = stretches_[stretch_at(at)];
    const double t = std::clamp(at, 0.0, time_) - s.begin;
    const bool moves = at >= 0 && at <= time_;
    return std::pair{s.place + t * (s.speed + 0.5 * t * s.acceleration),
                     moves ? s.speed + t * s.acceleration : 0};
  };
  const auto [from, slow] = moving(begin);
  const auto [to, fast] = moving(end);
  double sum = (to - from) * std::max(0.0, end - std::max(time_, begin));
  for (std::size_t i = first; i <= last; ++i) {
    const Stretch& s = stretches_[i];
    const double t0 = std::max(begin, s.begin) - s.begin,
                 t1 = std::clamp(end, s.begin, end_of(i)) - s.begin;
    const auto once = [&](double t) { return t * t * (s.speed / 2 + t * s.acceleration / 6); };
    sum += (s.place - from) * (t1 - t0) + once(t1) - once(t0);
  }
  return Progress{piece, std::clamp(from + sum / span_, 0.0, pieces_[piece].length),
                  std::max(0.0, (to - from) / (span_ * slower_)),
                  (fast - slow) / (span_ * slower_ * slower_)};
}

std::pair<double, double> TimeLaw::times_of(std::size_t piece) const {
  const auto first = std::ranges::lower_bound(stretches_, piece, {}, &Stretch::piece),
             end = std::ranges::upper_bound(stretches_, piece, {}, &Stretch::piece);
  const double begin = first->begin, done = end == stretches_.end() ? time_ : end->begin;
  return {slower_ * begin, slower_ * (done + span_)};
}

}  // namespace kaboum::motion
