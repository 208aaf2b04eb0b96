#pragma once

#include <kaboum/geom/transform.h>
#include <kaboum/robot/robot.h>

#include <span>
#include <vector>

namespace kaboum::judge {

/// Links of a robot on its base, in long double, rounded once.
std::vector<geom::Transform> places(const robot::Robot& robot, const geom::Transform& base,
                                    std::span<const double> q);

/// One pose after another, as places().
geom::Transform product(const geom::Transform& a, const geom::Transform& b);

}  // namespace kaboum::judge
