// Paths in time: from rest to rest, by polynomials of degree 5 or trapezoids of velocity.

#include <kaboum/base/error.h>
#include <kaboum/motion/trajectory.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

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

Trajectory::Trajectory(robot::Path path, const SpeedLimits& limits, double rate, Profile profile)
    : path_(std::move(path)), rate_(rate), profile_(profile) {
  if (path_.empty()) throw Error(ErrorCode::InvalidArgument, "a path without waypoints");
  for (const std::vector<double>& q : path_)
    if (q.size() != path_.front().size() ||
        !std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); }))
      throw Error(ErrorCode::InvalidArgument, "a waypoint that is not finite, or of another robot");
  if (!(rate > 0) || !std::isfinite(rate))
    throw Error(ErrorCode::InvalidArgument, "a rate must be above 0");
  require_positive(limits.velocity, path_.front().size(), "velocity");
  require_positive(limits.acceleration, path_.front().size(), "acceleration");
  first_.push_back(0);
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
    const double steps = std::ceil(time * kUp * rate);
    if (!(static_cast<double>(first_.back()) + steps < kMostSamples))
      throw Error(ErrorCode::LimitReached,
                  "the motion would take more than 100000000 samples: allow more speed, or a lower "
                  "rate");
    first_.push_back(first_.back() + static_cast<std::size_t>(steps));
  }
}

std::size_t Trajectory::segment_of(double step) const {
  std::size_t i = 0;
  while (i + 2 < first_.size() && step >= static_cast<double>(first_[i + 1])) ++i;
  return i;
}

Instant Trajectory::at(double time) const {
  const std::size_t count = path_.front().size();
  Instant out{path_.back(), std::vector<double>(count, 0), std::vector<double>(count, 0)};
  const double step = time * rate_;
  if (path_.size() < 2 || step >= static_cast<double>(first_.back())) return out;
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
  if (here != first_.end()) return path_[static_cast<std::size_t>(here - first_.begin())];
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
