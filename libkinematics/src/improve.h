#pragma once

#include <kaboum/kinematics/closed_form.h>

namespace kaboum::kinematics {

/// Newton's method on the arm itself, whole turns taken off. Whether it came within the bound.
bool improve(const ClosedForm& form, const Transform& target, const SolveOptions& options,
             Solution& solution);

}  // namespace kaboum::kinematics
