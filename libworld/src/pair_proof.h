#pragma once

#include <kaboum/world/allowed_pairs.h>

namespace kaboum::world::detail {

/// What is known of two links that are not adjacent: examine_pairs of one pair of shapes.
LinkPair examine_pair(const RobotModel& robot, const LinkShape& a, const LinkShape& b,
                      const PairOptions& options);

}  // namespace kaboum::world::detail
