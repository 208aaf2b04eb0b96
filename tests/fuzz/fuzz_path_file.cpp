// Any file of a path either makes waypoints of the robot, or throws Error: also where it could be
// read in two ways. The first byte selects options.

#include <kaboum/robot/path_file.h>

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>

#include "fuzz.h"

namespace {

using namespace kaboum;

/// Joints whose names are numbers, or begin alike.
robot::Robot arm() {
  robot::Robot out;
  out.name = "arm";
  out.links = {{"base", {}, {}}};
  for (const char* name : {"joint", "joint_2", "1"}) {
    robot::Joint joint;
    joint.name = name;
    joint.type = robot::JointType::Revolute;
    joint.parent = static_cast<std::uint32_t>(out.links.size()) - 1;
    joint.variable = static_cast<std::uint32_t>(out.variables.size());
    out.links.push_back({std::string("link of ") + name, {}, {}});
    out.variables.push_back({name, -1, 1, {}});
    out.joints.push_back(joint);
  }
  return out;
}

/// A file in memory, of these bytes.
std::string file_of(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("path", 0);
  if (file < 0 || ftruncate(file, 0) != 0 ||
      pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    fuzz::broken("a file in memory", "cannot be written");
  return "/proc/self/fd/" + std::to_string(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const robot::Robot robot = arm();
  robot::PathOptions options;
  options.check_limits = (data[0] & 1) != 0;
  options.degrees = (data[0] & 2) != 0;
  if ((data[0] & 4) != 0) options.fixed = {{"joint_2", 0.5}};
  const std::string file = file_of(data + 1, size - 1);
  fuzz::survive([&] {
    std::vector<std::string> notes;
    const robot::Path path = robot::read_path(file, robot, options, notes);
    for (const std::vector<double>& waypoint : path) {
      if (waypoint.size() != 3) fuzz::broken("a waypoint", "not one of the robot");
      for (const double x : waypoint)
        if (!std::isfinite(x) || (options.check_limits && std::abs(x) > 1.001))
          fuzz::broken("a value", std::to_string(x));
    }
    if (path.empty()) fuzz::broken("a path", "without waypoints");
    (void)robot::largest_move(path, robot);
  });
  return 0;
}
