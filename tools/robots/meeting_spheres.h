#pragma once

#include <kaboum/robot/robot.h>
#include <kaboum/robot/sphere_file.h>

#include <string>
#include <utility>
#include <vector>

namespace kaboum::tools {

/// Two links whose spheres meet in nearly all configurations: a planner that checks them finds no
/// way, although the links themselves may be apart.
struct MeetingLinks {
  std::string a, b;
  int of_thousand = 0;  ///< configurations
};

/// Of links that no joint connects directly: in a thousand configurations drawn within the limits
/// (within ±π where there are none), in rounded arithmetic.
/// @param unchecked  pairs of links, in any order, that planners are told to leave out
std::vector<MeetingLinks> meeting_links(
    const robot::Robot& robot, const robot::SphereFile& spheres,
    const std::vector<std::pair<std::string, std::string>>& unchecked);

/// What to tell of each: how often, and what to do.
/// @param epsilon  the option that states a smaller one
std::string text_of(const MeetingLinks& links, const std::string& epsilon);

}  // namespace kaboum::tools
