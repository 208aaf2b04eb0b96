// Values of joints within their limits: at random, and the nearest to one that is outside.
#include "joint_limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaboum::kinematics {

double random_value(const Axis& axis, double length, Random& random) {
  const double range = axis.turns ? std::numbers::pi / axis.rate : length / axis.rate;
  const double lower = std::isfinite(axis.lower)   ? axis.lower
                       : std::isfinite(axis.upper) ? axis.upper - 2 * range
                                                   : -range;
  const double upper = std::isfinite(axis.upper) ? axis.upper : lower + 2 * range;
  return random.between(lower, upper);
}

double into_limits(const Axis& axis, double q) {
  if (axis.turns && !(q >= axis.lower && q <= axis.upper)) {
    const double period = 2 * std::numbers::pi / axis.rate;
    const double near = q > axis.upper ? q - period * std::ceil((q - axis.upper) / period)
                                       : q + period * std::ceil((axis.lower - q) / period);
    if (near >= axis.lower && near <= axis.upper) return near;
  }
  return std::clamp(q, axis.lower, axis.upper);
}

double without_turns(const Axis& axis, double q) {
  if (!axis.turns || (std::isfinite(axis.lower) && std::isfinite(axis.upper))) return q;
  const double period = 2 * std::numbers::pi / axis.rate;
  return into_limits(axis, q - period * std::round(q / period));
}

}  // namespace kaboum::kinematics
