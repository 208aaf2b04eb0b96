// Any text given to the readers of robots either makes one that keeps what Robot promises and can
// be posed, or throws Error. The first byte selects the format.

#include <kaboum/robot/dynamics.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/robot.h>

#include "fuzz.h"

namespace {

using namespace kaboum;

void look_at(const robot::Robot& robot) {
  robot::require_valid(robot);
  const std::vector<robot::Transform> poses =
      robot::forward(robot, std::vector<double>(robot.variables.size(), 0.0));
  if (poses.size() != robot.links.size()) fuzz::broken("poses", "not one for each link");
  for (const robot::Link& link : robot.links)
    for (const robot::Geometry& g : link.collision)
      if (g.shape != robot::Geometry::Shape::Mesh && !robot::is_point(g) &&
          robot::bounding_points(g).size() < 4)
        fuzz::broken("bounding points", link.name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::select(data, size, 3, [](int kind, const std::string& text) {
    switch (kind) {
      case 0:
        look_at(robot::parse_urdf(text, "fuzz"));
        break;
      case 1:
        look_at(robot::parse_rl(text, "fuzz"));
        break;
      default:
        for (const auto& [link, inertial] : robot::parse_dynamics(text, "fuzz").links)
          if (!(inertial.mass >= 0)) fuzz::broken("mass", link);
    }
  });
}
