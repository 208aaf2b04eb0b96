// Paths in time: from rest to rest, by polynomials of degree 5 or trapezoids of velocity; through
// blended corners.

#include <kaboum/base/error.h>
#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/trajectory.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "time_law.h"

namespace kaboum::motion {
namespace {

// s(u) = 10u³ − 15u⁴ + 6u⁵: the largest values of its derivatives in [0, 1].
constexpr double kMostFirst = 1.875;               // at 1/2
constexpr double kMostSecond = 5.773502691896258;  // 10/√3, at 1/2 ± √3/6
constexpr double kUp = 1 + 0x1p-30;                // more than all roundings here
constexpr double kMostSamples = 1e8;

/// The share of a segment at a share of its time, and its derivatives.
struct Share {
  double value = 0, first = 0, second = 0;
};

Share quintic(double u) {
  return {u * u * u * (10 + u * (6 * u - 15)), 30 * u * u * (1 - u) * (1 - u),
          60 * u * (1 - u) * (1 - 2 * u)};
}

/// Speeds up for the part `ramp` of the time, at most a half, and slows down as long.
Share trapezoid(double u, double ramp) {
  const double top = 1 / (1 - ramp), slope = top / ramp;
  if (u < ramp) return {0.5 * slope * u * u, slope * u, slope};
  if (u <= 1 - ramp) return {top * (u - 0.5 * ramp), top, 0};
  const double left = 1 - u;
  return {1 - 0.5 * slope * left * left, slope * left, -slope};
}

void require_positive(const std::vector<double>& values, std::size_t count, const char* what) {
  if (values.size() != count || !std::all_of(values.begin(), values.end(),
                                             [](double x) { return x > 0 && std::isfinite(x); }))
    throw Error(ErrorCode::InvalidArgument,
                std::string("a limit of ") + what + " above 0 is needed for each variable");
}

/// How far it is from an end of a straight line, and its derivatives by the share of a step.
struct AlongEnd {
  double distance = 0, first = 0, second = 0;
};

/// Whether the cubic or quintic polynomial between two samples may go beyond the end: not where all
/// its Bézier ordinates are on the same side of it, but for the rounding of a place.
bool may_overshoot(const AlongEnd& a, const AlongEnd& b, double length) {
  return std::min({a.distance + a.first / 3, b.distance - b.first / 3, a.distance + a.first / 5,
                   a.distance + 0.4 * a.first + a.second / 20,
                   b.distance - 0.4 * b.first + b.second / 20, b.distance - b.first / 5}) <
         -0x1p-46 * length;
}

void append(std::string& out, double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  out.append(text.data(), end);
}

void append_values(std::string& out, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    append(out, values[i]);
  }
  out += '\n';
}

std::string names(const robot::Robot& robot) {
  std::string out;
  for (const robot::Variable& v : robot.variables) {
    if (!out.empty()) out += ',';
    out += robot::csv_field(v.name);
  }
  return out + '\n';
}

}  // namespace

/// The time along a path with blends, from stop to stop.
struct Trajectory::Blended {
  struct Leg {
    TimeLaw law;
    double stretch = 1;  ///< of its time, at least 1, to a whole number of samples
  };
  std::vector<Leg> legs;
  std::vector<std::size_t> stopping;                       ///< waypoints, one more than legs
  std::vector<double> passed;                              ///< time of each waypoint [s]
  std::vector<std::pair<std::size_t, std::size_t>> bends;  ///< Trajectory::bends
};

void Trajectory::require_valid(const SpeedLimits& limits) const {
  if (path_.empty()) throw Error(ErrorCode::InvalidArgument, "a path without waypoints");
  for (const std::vector<double>& q : path_)
    if (q.size() != path_.front().size() ||
        !std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); }))
      throw Error(ErrorCode::InvalidArgument, "a waypoint that is not finite, or of another robot");
  if (!(rate_ > 0) || !std::isfinite(rate_))
    throw Error(ErrorCode::InvalidArgument, "a rate must be above 0");
  require_positive(limits.velocity, path_.front().size(), "velocity");
  require_positive(limits.acceleration, path_.front().size(), "acceleration");
}

/// The next stop is so much later, or up to a sample more.
void Trajectory::append_steps(double time) {
  const double steps = std::ceil(time * kUp * rate_);
  if (!(static_cast<double>(first_.back()) + steps < kMostSamples))
    throw Error(ErrorCode::LimitReached,
                "the motion would take more than 100000000 samples: allow more speed, or a lower "
                "rate");
  first_.push_back(first_.back() + static_cast<std::size_t>(steps));
}

Trajectory::Trajectory(robot::Path path, const SpeedLimits& limits, double rate, Profile profile)
    : path_(std::move(path)), rate_(rate), profile_(profile), first_{0} {
  require_valid(limits);
  for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
    double time = 0, slowest = 0, laziest = 0;
    for (std::size_t j = 0; j < path_[i].size(); ++j) {
      const double change = std::abs(path_[i + 1][j] - path_[i][j]);
      slowest = std::max(slowest, change / limits.velocity[j]);
      laziest = std::max(laziest, change / limits.acceleration[j]);
    }
    if (profile == Profile::Quintic) {
      time = std::max(kMostFirst * slowest, std::sqrt(kMostSecond * laziest));
      ramp_.push_back(0.5);
    } else {
      // To the speed 1 / slowest in laziest / slowest, if the way is long enough for that.
      const bool reaches = slowest * slowest > laziest;
      time = reaches ? slowest + laziest / slowest : 2 * std::sqrt(laziest);
      ramp_.push_back(reaches ? std::min(0.5, laziest / slowest / time) : 0.5);
    }
    append_steps(time);
  }
}

/// Adds the steps next to both ends of the last leg in which a controller's polynomials may go
/// beyond the end (docs/algorithms/motion-planning.md#blended-corners).
void Trajectory::add_overshoots(const TimeLaw& law, std::span<const PathPiece> pieces,
                                double stretch, const SpeedLimits& limits,
                                std::vector<std::pair<std::size_t, std::size_t>>& bends) const {
  const std::size_t begin = first_[first_.size() - 2], end = first_.back();
  for (const bool from_end : {false, true}) {
    const std::size_t piece = from_end ? pieces.size() - 1 : 0;
    const std::vector<double> direction = pieces[piece].at(0).first;
    double most = std::numeric_limits<double>::infinity();  // acceleration along the piece
    for (std::size_t j = 0; j < direction.size(); ++j)
      most = std::min(most, limits.acceleration[j] / std::abs(direction[j]));
    AlongEnd last;
    for (std::size_t k = 1; begin + k <= end; ++k) {
      const std::size_t step = from_end ? end - begin - k : k;
      const auto now = law.straight_at(static_cast<double>(step) / rate_ / stretch);
      if (!now || now->piece != piece) break;  // at a blend, or behind it
      const double share = 1 / (stretch * rate_), sign = from_end ? -1 : 1;
      const AlongEnd next{from_end ? pieces[piece].length - now->place : now->place,
                          now->speed * share, sign * now->acceleration * share * share};
      if (may_overshoot(last, next, pieces[piece].length))
        bends.emplace_back(from_end ? end - k : begin + k - 1, from_end ? end - k + 1 : begin + k);
      if (next.distance >= 0.1875 * most / (rate_ * rate_)) break;
      last = next;
    }
  }
}

Trajectory::Trajectory(robot::Path path, const std::vector<double>& shares,
                       const SpeedLimits& limits, double rate)
    : path_(std::move(path)), rate_(rate), first_{0} {
  require_valid(limits);
  require_positive(limits.jerk, path_.front().size(), "jerk");
  const BlendedPath curve(path_, shares, limits.velocity);
  auto made = std::make_shared<Blended>();
  made->stopping = curve.stopping_waypoints();
  made->passed.assign(path_.size(), -1);
  made->passed[0] = 0;
  for (std::size_t i = 0; i + 1 < curve.stops().size(); ++i) {
    const std::size_t first = curve.stops()[i], end = curve.stops()[i + 1];
    const std::span<const PathPiece> pieces = std::span(curve.pieces()).subspan(first, end - first);
    TimeLaw law(pieces, limits);
    const double begin = static_cast<double>(first_.back()) / rate_;
    append_steps(law.duration());
    const double whole = static_cast<double>(first_.back()) / rate_ - begin,
                 stretch = whole / law.duration();
    std::vector<std::pair<std::size_t, std::size_t>> bends;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (!pieces[k].is_blend) continue;
      const auto [enters, leaves] = law.times_of(k);
      made->passed[pieces[k].waypoint] = begin + stretch * 0.5 * (enters + leaves);
      // A little more: what rounding may take from the times is far less than that of a sample.
      constexpr double kRounding = 1e-6;
      const auto step = [&](double time) { return stretch * time * rate_; };
      const std::size_t before = first_[i] + static_cast<std::size_t>(std::max(
                                                 0.0, std::floor(step(enters) - kRounding))),
                        after = std::min(first_.back(),
                                         first_[i] + static_cast<std::size_t>(
                                                         std::ceil(step(leaves) + kRounding)));
      bends.emplace_back(before, after);
    }
    add_overshoots(law, pieces, stretch, limits, bends);
    std::ranges::sort(bends);
    for (const auto& bend : bends) {
      if (made->bends.empty() || made->bends.back().second < bend.first)
        made->bends.push_back(bend);
      else
        made->bends.back().second = std::max(made->bends.back().second, bend.second);
    }
    const std::size_t stop = made->stopping[i + 1];
    made->passed[stop] = begin + whole;
    // Waypoints that are the same as the stop, but before it.
    for (std::size_t k = stop; k-- > 0 && path_[k] == path_[stop];) made->passed[k] = begin + whole;
    made->legs.push_back({std::move(law), stretch});
  }
  for (std::size_t i = 1; i < path_.size(); ++i)  // those that are the same as the one before
    if (made->passed[i] < 0) made->passed[i] = made->passed[i - 1];
  blended_ = std::move(made);
}

double Trajectory::time_at(std::size_t waypoint) const {
  if (blended_) return blended_->passed.at(waypoint);
  return static_cast<double>(first_.at(waypoint)) / rate_;
}

std::vector<std::pair<std::size_t, std::size_t>> Trajectory::bends() const {
  if (!blended_) return {};
  return blended_->bends;
}

/// @pre step is below the last sample
Instant Trajectory::blended_at(double step) const {
  const Blended& b = *blended_;
  const std::size_t i = segment_of(step);
  const Blended::Leg& leg = b.legs[i];
  Instant out =
      leg.law.at(std::max(0.0, step - static_cast<double>(first_[i])) / rate_ / leg.stretch);
  for (double& x : out.velocity) x /= leg.stretch;
  for (double& x : out.acceleration) x /= leg.stretch * leg.stretch;
  return out;
}

std::size_t Trajectory::segment_of(double step) const {
  std::size_t i = 0;
  while (i + 2 < first_.size() && step >= static_cast<double>(first_[i + 1])) ++i;
  return i;
}

Instant Trajectory::instant(std::size_t k) const {
  Instant out = at_step(static_cast<double>(k));
  out.q = sample(k);
  // At a stop trapezoids have two accelerations; 0 leads along neither of the segments.
  if (std::ranges::binary_search(first_, k))
    out.velocity = out.acceleration = std::vector<double>(out.q.size(), 0);
  return out;
}

Instant Trajectory::at_step(double step) const {
  const std::size_t count = path_.front().size();
  Instant out{path_.back(), std::vector<double>(count, 0), std::vector<double>(count, 0)};
  if (path_.size() < 2 || step >= static_cast<double>(first_.back())) return out;
  if (blended_) return blended_at(step);
  const std::size_t i = segment_of(step);
  const auto steps = static_cast<double>(first_[i + 1] - first_[i]);
  const double u = std::clamp((step - static_cast<double>(first_[i])) / steps, 0.0, 1.0);
  const double length = steps / rate_;
  const Share share = profile_ == Profile::Quintic ? quintic(u) : trapezoid(u, ramp_[i]);
  for (std::size_t j = 0; j < count; ++j) {
    const double change = path_[i + 1][j] - path_[i][j];
    out.q[j] = path_[i][j] + share.value * change;
    out.velocity[j] = share.first * change / length;
    out.acceleration[j] = share.second * change / (length * length);
  }
  return out;
}

std::vector<double> Trajectory::sample(std::size_t k) const {
  const auto here = std::find(first_.begin(), first_.end(), k);
  if (here != first_.end()) {
    const auto stop = static_cast<std::size_t>(here - first_.begin());
    return path_[blended_ ? blended_->stopping[stop] : stop];
  }
  if (blended_) return blended_at(static_cast<double>(k)).q;
  const std::size_t i = segment_of(static_cast<double>(k));
  const double u =
      static_cast<double>(k - first_[i]) / static_cast<double>(first_[i + 1] - first_[i]);
  const double share = (profile_ == Profile::Quintic ? quintic(u) : trapezoid(u, ramp_[i])).value;
  std::vector<double> q = path_[i];
  for (std::size_t j = 0; j < q.size(); ++j) q[j] += share * (path_[i + 1][j] - q[j]);
  return q;
}

std::string to_csv(const Trajectory& trajectory, const robot::Robot& robot, AngleUnit unit) {
  robot::Path path;
  path.reserve(trajectory.samples());
  for (std::size_t k = 0; k < trajectory.samples(); ++k) path.push_back(trajectory.sample(k));
  if (unit == AngleUnit::Degrees) path = robot::to_degrees(std::move(path), robot);
  std::string out = "time_from_start," + names(robot);
  for (std::size_t k = 0; k < path.size(); ++k) {
    append(out, static_cast<double>(k) / trajectory.rate());
    out += ',';
    append_values(out, path[k]);
  }
  return out;
}

std::string to_csv(const robot::Path& path, const robot::Robot& robot, AngleUnit unit) {
  std::string out = names(robot);
  for (const std::vector<double>& q :
       unit == AngleUnit::Degrees ? robot::to_degrees(path, robot) : path)
    append_values(out, q);
  return out;
}

}  // namespace kaboum::motion
