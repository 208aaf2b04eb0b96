// Whole turns added to joints, within their limits.
#include <kaboum/kinematics/copies.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaboum::kinematics {
namespace {

/// First and last multiple of a period that may be added to q; for joints that move along, 0.
struct Turns {
  double first = 0, last = 0, period = 0;
};

Turns turns_of(const Axis& axis, double q) {
  Turns t;
  if (!axis.turns) {
    t.last = q >= axis.lower && q <= axis.upper ? 0 : -1;
    return t;
  }
  t.period = 2 * std::numbers::pi / axis.rate;
  t.first = std::ceil((axis.lower - kOnLimit - q) / t.period);
  t.last = std::floor((axis.upper + kOnLimit - q) / t.period);
  return t;
}

double copy(const Axis& axis, double q, const Turns& t, double k) {
  if (!axis.turns) return q;
  return std::clamp(q + k * t.period, axis.lower, axis.upper);
}

/// The copy of one joint that is nearest to a value.
std::optional<double> nearest(const Axis& axis, double q, double reference) {
  const Turns t = turns_of(axis, q);
  if (t.first > t.last) return std::nullopt;
  if (!axis.turns) return q;
  const double k = std::round((reference - q) / t.period);
  return copy(axis, q, t, std::clamp(k, t.first, t.last));
}

std::vector<double> values(const Axis& axis, double q, std::size_t most) {
  std::vector<double> out;
  if (!std::isfinite(axis.lower) || !std::isfinite(axis.upper)) {
    if (const auto value = nearest(axis, q, 0)) out.push_back(*value);
    return out;
  }
  const Turns t = turns_of(axis, q);
  for (double k = t.first; k <= t.last && out.size() < most; ++k)
    out.push_back(copy(axis, q, t, k));
  return out;
}

}  // namespace

std::optional<std::vector<double>> nearest_copy(const Arm& arm, std::span<const double> q,
                                                std::span<const double> reference) {
  std::vector<double> out(arm.axes.size());
  if (!find_nearest_copy(arm, q, reference, out)) return std::nullopt;
  return out;
}

bool find_nearest_copy(const Arm& arm, std::span<const double> q, std::span<const double> reference,
                       std::span<double> out) {
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    const auto value = nearest(arm.axes[i], q[i], reference[i]);
    if (!value) return false;
    out[i] = *value;
  }
  return true;
}

std::vector<std::vector<double>> copies(const Arm& arm, std::span<const double> q,
                                        std::size_t most) {
  std::vector<std::vector<double>> out{{}};
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    std::vector<std::vector<double>> longer;
    const std::vector<double> choices = values(arm.axes[i], q[i], most);
    for (const std::vector<double>& start : out)
      for (const double value : choices) {
        if (longer.size() == most) break;
        longer.push_back(start);
        longer.back().push_back(value);
      }
    out = std::move(longer);
  }
  return out;
}

double count_copies(const Arm& arm, std::span<const double> q) {
  double count = 1;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    const Axis& axis = arm.axes[i];
    const Turns t = turns_of(axis, q[i]);
    const bool limited = std::isfinite(axis.lower) && std::isfinite(axis.upper);
    count *= limited || t.first > t.last ? std::max(0.0, t.last - t.first + 1) : 1;
  }
  return count;
}

}  // namespace kaboum::kinematics
