#pragma once

#include <kaboum/kinematics/arm.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace kaboum::kinematics {

/// Distance outside a limit that counts as being on it: solutions are rounded. [rad]
constexpr double kOnLimit = 1e-11;

/// True if whole turns bring a joint's value within its limits, or no farther outside than `slack`.
inline bool has_copy(const Axis& axis, double q, double slack) {
  if (q >= axis.lower - slack && q <= axis.upper + slack) return true;
  if (!axis.turns) return false;
  const double turn = 2 * std::numbers::pi / axis.rate;
  return std::floor((axis.upper + slack - q) / turn) >= std::ceil((axis.lower - slack - q) / turn);
}

/// The configuration within the limits that is nearest to `reference` and differs from q by whole
/// turns of joints that turn; nullopt when there is none.
/// @pre one value per axis in q and in reference. [rad or length]
std::optional<std::vector<double>> nearest_copy(const Arm& arm, std::span<const double> q,
                                                std::span<const double> reference);
/// The same into other memory, `out`; false where there is none.
/// @pre one value per axis in `out`, too.
bool find_nearest_copy(const Arm& arm, std::span<const double> q, std::span<const double> reference,
                       std::span<double> out);

/// All configurations within the limits that differ from q by whole turns, in lexicographic order.
/// A joint that is not limited on both sides takes one value, the nearest to 0.
/// @param most  no more are returned than this.
std::vector<std::vector<double>> copies(const Arm& arm, std::span<const double> q,
                                        std::size_t most = 4096);

/// Number of results that `copies` has without `most`.
double count_copies(const Arm& arm, std::span<const double> q);

}  // namespace kaboum::kinematics
