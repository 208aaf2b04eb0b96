// The files that kaboum-move writes: waypoints, and samples over time.

#include "files.h"

#include <kaboum/base/error.h>
#include <kaboum/motion/sampled_path.h>

namespace kaboum::tools {
namespace {

motion::AngleUnit unit_of(const MoveOptions& o) {
  return o.degrees ? motion::AngleUnit::Degrees : motion::AngleUnit::Radians;
}

}  // namespace

WrittenPath write_path(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                       const world::Checker& checker) {
  WrittenPath out;
  out.csv = motion::to_csv(path, r.kinematics(), unit_of(o));
  out.path = motion::parse_path(out.csv, r.kinematics(), unit_of(o));
  if (out.path == path) return out;
  ensure(o.degrees, "a path is written as another one");
  const world::WorldState state = initial_state(r.scene.world);
  motion::require_free({checker, state, r.robot, r.constraints, r.around}, out.path,
                       o.search.check.resolution, "--degrees: the waypoints, rounded,");
  return out;
}

Execution execute(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                  const world::Checker& checker) {
  const world::WorldState state = initial_state(r.scene.world);
  motion::SampledPath made =
      motion::sample_path({checker, state, r.robot, r.constraints, r.around}, path, o.execution,
                          o.search.check.resolution, unit_of(o));
  Json report = {{"file", o.trajectory},
                 {"rate", o.execution.rate},
                 {"samples", made.trajectory.samples()},
                 {"max_velocity", made.limits.velocity},
                 {"max_acceleration", made.limits.acceleration},
                 {"seconds", made.trajectory.duration()}};
  if (!made.blends.empty()) {
    report["max_jerk"] = made.limits.jerk;
    report["blends"] = made.blends;
    report["between_samples"] = made.between_samples;
  }
  const auto format = motion::message_format(o.trajectory);
  return {
      format ? to_joint_trajectory(made.trajectory, r.kinematics(), *format) : std::move(made.csv),
      std::move(report)};
}

}  // namespace kaboum::tools
