// Paths in time: polynomials of degree 5 from rest to rest.

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

double share_at(double u) { return u * u * u * (10 + u * (6 * u - 15)); }
double first_at(double u) { return 30 * u * u * (1 - u) * (1 - u); }
double second_at(double u) { return 60 * u * (1 - u) * (1 - 2 * u); }

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
    out += v.name;
  }
  return out + '\n';
}

}  // namespace

Trajectory::Trajectory(robot::Path path, const SpeedLimits& limits, double rate)
    : path_(std::move(path)), rate_(rate) {
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
    double time = 0;
    for (std::size_t j = 0; j < path_[i].size(); ++j) {
      const double change = std::abs(path_[i + 1][j] - path_[i][j]);
      time = std::max({time, kMostFirst * change / limits.velocity[j],
                       std::sqrt(kMostSecond * change / limits.acceleration[j])});
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
  for (std::size_t j = 0; j < count; ++j) {
    const double change = path_[i + 1][j] - path_[i][j];
    out.q[j] = path_[i][j] + share_at(u) * change;
    out.velocity[j] = first_at(u) * change / length;
    out.acceleration[j] = second_at(u) * change / (length * length);
  }
  return out;
}

std::vector<double> Trajectory::sample(std::size_t k) const {
  const auto here = std::find(first_.begin(), first_.end(), k);
  if (here != first_.end()) return path_[static_cast<std::size_t>(here - first_.begin())];
  const std::size_t i = segment_of(static_cast<double>(k));
  const double u =
      static_cast<double>(k - first_[i]) / static_cast<double>(first_[i + 1] - first_[i]);
  std::vector<double> q = path_[i];
  for (std::size_t j = 0; j < q.size(); ++j) q[j] += share_at(u) * (path_[i + 1][j] - q[j]);
  return q;
}

std::string to_csv(const Trajectory& trajectory, const robot::Robot& robot) {
  std::string out = "time_from_start," + names(robot);
  for (std::size_t k = 0; k < trajectory.samples(); ++k) {
    append(out, static_cast<double>(k) / trajectory.rate());
    out += ',';
    append_values(out, trajectory.sample(k));
  }
  return out;
}

std::string to_csv(const robot::Path& path, const robot::Robot& robot) {
  std::string out = names(robot);
  for (const std::vector<double>& q : path) append_values(out, q);
  return out;
}

}  // namespace kaboum::motion
