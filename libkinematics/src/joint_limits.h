#pragma once

#include <kaboum/base/random.h>
#include <kaboum/kinematics/arm.h>

namespace kaboum::kinematics {

/// A value of the joint, uniform within its limits; where there are none, within a turn about 0, or
/// `length` to either side.
double random_value(const Axis& axis, double length, Random& random);

/// The value within the limits that is nearest to q, after the whole turns that bring it there.
double into_limits(const Axis& axis, double q);

/// Turns of joints without limits on both sides taken off: near 0, as far as the limits allow.
double without_turns(const Axis& axis, double q);

}  // namespace kaboum::kinematics
