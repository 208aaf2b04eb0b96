#pragma once

#include <kaboum/certify/convex_set.h>

#include "arguments.h"

/// What decompose and certify_robot are asked of sets, as bcd-decompose.
namespace kaboum::python {

inline constexpr std::array<std::pair<const char*, bcd::Effort>, 3> kSetEfforts{
    {{"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}}};
inline constexpr std::array<std::pair<const char*, bcd::Method>, 3> kMethods{
    {{"planes", bcd::Method::Planes},
     {"clusters", bcd::Method::Clusters},
     {"voxels", bcd::Method::Voxels}}};
inline constexpr std::array<std::pair<const char*, bcd::PreStep>, 3> kPreSteps{
    {{"auto", bcd::PreStep::Auto}, {"on", bcd::PreStep::On}, {"off", bcd::PreStep::Off}}};
using SetDirection = certify::SetRequest::Direction;
inline constexpr std::array<std::pair<const char*, SetDirection>, 2> kSetDirections{
    {{"outer", SetDirection::Outer}, {"inner", SetDirection::Inner}}};

}  // namespace kaboum::python
