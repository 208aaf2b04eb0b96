#pragma once

#include <kaboum/base/option.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/motion_check.h>

namespace kaboum::world {

/// The options of looking at one state: resting.
const std::vector<Option<Checker::Options>>& state_options();

/// The option of a cloud's radius: cloud-radius.
OptionDescription cloud_radius_option();

/// The options of deciding a motion: resolution, max-intervals.
const std::vector<Option<MotionOptions>>& motion_options();

/// The options of examining pairs of links: max-boxes, timeout.
const std::vector<Option<PairOptions>>& pair_options();

}  // namespace kaboum::world
