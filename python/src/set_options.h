#pragma once

#include <kaboum/certify/convex_set.h>

#include "arguments.h"

/// Words of the options of sets that sweep and certify_robot state themselves.
namespace kaboum::python {

inline constexpr std::array<std::pair<const char*, bcd::Effort>, 3> kSetEfforts{
    {{"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}}};

}  // namespace kaboum::python
