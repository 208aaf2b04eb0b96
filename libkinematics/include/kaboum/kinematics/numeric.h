#pragma once

#include <kaboum/kinematics/arm.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::kinematics {

struct NumericOptions {
  std::uint64_t seed = 1;
  int starts = 100;           ///< configurations to start from: the first is `first`, if given
  int iterations = 100;       ///< from each of them
  std::size_t solutions = 0;  ///< different ones after which `solve_numeric_all` ends; 0: never
  double bound = 1e-10;       ///< on the position's error in parts of the reach, and the rotation's
  bool limits = true;         ///< whether solutions are to be within the joints' limits
  std::vector<double> first;  ///< empty: random as well
  /// Is told of each start; what it throws ends the work.
  std::function<void(const std::string& stage)> progress = {};
};

struct NumericSolution {
  std::vector<double> q;  ///< [rad or length]
  PoseError error;
  int starts = 0;  ///< that were needed
};

/// A configuration of any serial arm that reaches a pose: damped least squares from random starts.
/// nullopt says that none was found, not that there is none. The same arguments give the same
/// answer, to the bit.
/// @throws Error{InvalidArgument} when `first` has not one value per axis.
std::optional<NumericSolution> solve_numeric(const Arm& arm, const Transform& target,
                                             const NumericOptions& options = {});

/// The different configurations found from all starts, or the first `solutions` of them, in the
/// order found; perhaps not all that there are. Two are the same when no joint differs by more than
/// 1e-6, whole turns apart.
std::vector<NumericSolution> solve_numeric_all(const Arm& arm, const Transform& target,
                                               const NumericOptions& options = {});

}  // namespace kaboum::kinematics
