#pragma once

#include <kaboum/kinematics/closed_form.h>

#include <optional>
#include <vector>

namespace kaboum::kinematics {

/// An arm with more than six axes whose last six have a closed form: an arm on a rail, on a
/// platform that moves in a plane, on a torso. The joints before those six are redundant: they are
/// free parameters, and for each value of them the closed form gives the others.
struct RedundantArm {
  Arm arm;                ///< all of it
  std::size_t count = 0;  ///< of redundant joints, the arm's first ones
  Arm carrier;            ///< the redundant joints; its tool is the base's frame
  ClosedForm form;        ///< of the last six axes, at 0 of the redundant joints
};

/// The redundant joints of an arm, at most six; nothing where its last six axes are of no family,
/// or nothing is before them.
std::optional<RedundantArm> recognise_redundant(const Arm& arm);

struct RedundantOptions {
  /// A value for each axis: redundant joints have it first, then values near to it; whole turns
  /// nearest to it are chosen. Empty: zeros. [rad or length]
  std::vector<double> reference;
  bool limits = true;  ///< whether configurations are those within the joints' limits
  /// Of the redundant joints, values for which there are configurations: so many are sought …
  std::size_t values = 6;
  std::size_t tries = 1000;  ///< … among so many. More of both find what fewer find, and more.
  double bound = 1e-9;       ///< on the errors, as SolveOptions::bound
};

struct RedundantSolution {
  std::vector<double> q;  ///< a value for each axis; turns of the last six are in (−π, π]
  PoseError error;        ///< of the whole arm, by forward kinematics
  unsigned singular = kRegular;
};

struct RedundantSolutions {
  /// Those that move the redundant joints least from the reference first.
  std::vector<RedundantSolution> found;
  /// None is found, and it is proved that there is none: for no values of the redundant joints
  /// within their limits does the arm's wrist reach the target's.
  bool out_of_reach = false;
};

/// Configurations of a redundant arm that reach a pose: the redundant joints take the reference's
/// values and then those of a sequence that fills their limits evenly (Halton's); a joint that
/// moves along takes values with which the wrist can be reached only. Without `out_of_reach`, none
/// found says nothing. The same arguments give the same answer, to the bit.
/// @throws Error{InvalidArgument} when the reference has not one value per axis.
RedundantSolutions solve_redundant(const RedundantArm& arm, const Transform& target,
                                   const RedundantOptions& options = {});

/// Those with given values of the redundant joints, at most eight.
/// @param reference  a value for each axis, of which the redundant joints are kept.
std::vector<RedundantSolution> solve_with_redundant(const RedundantArm& arm,
                                                    const Transform& target,
                                                    std::span<const double> reference,
                                                    const RedundantOptions& options = {});

}  // namespace kaboum::kinematics
