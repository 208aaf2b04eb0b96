#pragma once

#include <functional>
#include <vector>

namespace kaboum::collide {

using Configuration = std::vector<double>;

/// Configurations that OMPL's RRT-Connect asks about while it plans from `start` to `goal`, in
/// order, each variable within ±range; planning is repeated with other random numbers until there
/// are `wanted` or 200 times as many were asked. @return the first `wanted`; `solved` counts the
/// plans found.
std::vector<Configuration> record_queries(const Configuration& start, const Configuration& goal,
                                          double range,
                                          const std::function<bool(const Configuration&)>& valid,
                                          std::size_t wanted, std::size_t& solved);

}  // namespace kaboum::collide
