// Any text given to the readers of paths and poses either makes finite numbers, as many in each
// waypoint, or throws Error. The first byte selects the format.

#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/path.h>

#include <cmath>

#include "fuzz.h"

namespace {

using namespace kaboum;

/// Two joints, a path's columns in another order, and times.
robot::Robot arm() {
  robot::Robot out;
  out.name = "arm";
  out.links = {{"base", {}, {}}, {"upper", {}, {}}, {"lower", {}, {}}};
  for (std::uint32_t j = 0; j < 2; ++j) {
    robot::Joint joint;
    joint.name = j == 0 ? "shoulder" : "elbow";
    joint.type = robot::JointType::Revolute;
    joint.parent = j;
    joint.variable = j;
    out.variables.push_back({joint.name, -1, 1, {}});
    out.joints.push_back(joint);
  }
  return out;
}

void look_at(const robot::NamedPath& path) {
  for (const std::vector<double>& waypoint : path.waypoints) {
    if (waypoint.size() != path.waypoints.front().size() ||
        (!path.joints.empty() && waypoint.size() != path.joints.size()))
      fuzz::broken("a waypoint", "of another width");
    for (const double x : waypoint)
      if (!std::isfinite(x)) fuzz::broken("a value", std::to_string(x));
  }
  for (const std::vector<double>& waypoint : robot::arrange(path, arm(), "fuzz"))
    if (waypoint.size() != 2) fuzz::broken("a waypoint", "not one of the robot");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::select(data, size, 3, [](int kind, const std::string& text) {
    switch (kind) {
      case 0:
        look_at(robot::parse_path_csv(text, "fuzz"));
        break;
      case 1:
        look_at(robot::parse_path_json(text, "fuzz"));
        break;
      default: {
        const robot::Transform pose = robot::parse_pose(text, "--pose");
        const robot::Transform again = robot::parse_pose(robot::base_pose_text(pose), "--pose");
        if (!pose.linear.allFinite() || !pose.translation.allFinite() ||
            again.linear != pose.linear || again.translation != pose.translation)
          fuzz::broken("a pose", robot::base_pose_text(pose));
      }
    }
  });
}
