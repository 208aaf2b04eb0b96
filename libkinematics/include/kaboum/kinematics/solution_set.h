#pragma once

#include <kaboum/kinematics/closed_form.h>

#include <string>
#include <vector>

namespace kaboum::kinematics {

/// Values of a joint, both ends included. [rad]
struct JointRange {
  double lower = 0, upper = 0;
};

/// Configurations that reach one pose and hang together: some joints may be chosen, the others
/// follow. One free joint makes a curve; two or three, where several axes are aligned, a surface.
struct SolutionFamily {
  std::vector<std::size_t> free;  ///< the joints that may be chosen
  unsigned singular = kRegular;   ///< of Singular
  /// Values of one free joint to which a configuration within the limits belongs, whole turns
  /// apart, ascending, exact to 1e-5. Of several: for each of them one range that holds all such
  /// values.
  std::vector<JointRange> ranges;
  /// Configurations of the family within the limits, evenly spread over the ranges; whole turns are
  /// those nearest to the reference.
  std::vector<Solution> representatives;
};

/// All configurations that reach a pose.
struct SolutionSet {
  Solutions isolated;                    ///< whatever the limits, each in (−π, π]
  std::vector<SolutionFamily> families;  ///< those that have a configuration within the limits
  /// There is nothing else within the limits, whole turns apart, up to the accuracy of closed forms
  /// (SolveOptions::bound). Every configuration is one of `isolated` up to its `accuracy`, 1e-5 at
  /// most, or one of a family up to what its ranges are exact to. Families without a configuration
  /// within the limits were proved to have none.
  bool complete = true;
  std::string reason;  ///< why it is not complete
};

struct SolutionSetOptions {
  SolveOptions solve = {};
  bool limits = true;                ///< whether families are those within the joints' limits
  std::size_t representatives = 16;  ///< of each family, about
};

/// As `solve`, but where a joint is free with the families that it makes instead of one
/// configuration of them (docs/algorithms/inverse-kinematics.md#families-of-solutions).
SolutionSet solve_set(const ClosedForm& form, const Transform& target,
                      const SolutionSetOptions& options = {});

}  // namespace kaboum::kinematics
