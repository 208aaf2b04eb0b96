#pragma once

#include <kaboum/base/option.h>
#include <kaboum/robot/link_meshes.h>

namespace kaboum::robot {

/// The options of which shapes of a robot are meant: links, geometry, package-path.
const std::vector<Option<ShapeChoice>>& shape_options();

/// These, and missing-meshes, for what says of each link whether it is held.
const std::vector<Option<ShapeChoice>>& held_shape_options();

}  // namespace kaboum::robot
