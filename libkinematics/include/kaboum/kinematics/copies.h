#pragma once

#include <kaboum/kinematics/arm.h>

#include <optional>
#include <vector>

namespace kaboum::kinematics {

/// Distance outside a limit that counts as being on it: solutions are rounded. [rad]
constexpr double kOnLimit = 1e-11;

/// The configuration within the limits that is nearest to `reference` and differs from q by whole
/// turns of joints that turn; nullopt when there is none.
/// @pre one value per axis in q and in reference. [rad or length]
std::optional<std::vector<double>> nearest_copy(const Arm& arm, std::span<const double> q,
                                                std::span<const double> reference);

/// All configurations within the limits that differ from q by whole turns, in lexicographic order.
/// A joint that is not limited on both sides takes one value, the nearest to 0.
/// @param most  no more are returned than this.
std::vector<std::vector<double>> copies(const Arm& arm, std::span<const double> q,
                                        std::size_t most = 4096);

/// Number of results that `copies` has without `most`.
double count_copies(const Arm& arm, std::span<const double> q);

}  // namespace kaboum::kinematics
