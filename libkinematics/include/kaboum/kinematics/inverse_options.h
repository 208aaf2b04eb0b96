#pragma once

#include <kaboum/base/option.h>
#include <kaboum/kinematics/inverse.h>

namespace kaboum::kinematics {

/// The options of a request for configurations.
const std::vector<Option<InverseRequest>>& inverse_options();

}  // namespace kaboum::kinematics
