#pragma once

#include <kaboum/robot/robot.h>

#include <cstdint>
#include <vector>

namespace kaboum::pairs {

/// Relation of two links, whatever their shapes.
enum class Relation {
  Moving,    ///< several joints, or other links, are between them
  Adjacent,  ///< one joint that moves connects them, but for fixed frames without shapes between
  Fixed,     ///< only fixed joints are between them, one or several
};
/// "moving", "adjacent", "fixed".
const char* name_of(Relation relation);

/// Of each link, whether it has shapes.
using Shaped = std::vector<char>;

/// Whether one joint connects both, fixed or not, with nothing that has shapes between them.
bool are_adjacent(const robot::Robot& robot, const Shaped& shaped, std::uint32_t a,
                  std::uint32_t b);

/// Fixed, if they are; else Adjacent, if they are.
Relation relation_of(const robot::Robot& robot, const Shaped& shaped, std::uint32_t a,
                     std::uint32_t b);

}  // namespace kaboum::pairs
