// The files that kaboum-move writes: waypoints, and samples over time.

#include "files.h"

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/motion/sampled_path.h>

#include <sstream>

#include "common/shell_word.h"

namespace kaboum::tools {
namespace {

motion::AngleUnit unit_of(const MoveOptions& o) {
  return o.degrees ? motion::AngleUnit::Degrees : motion::AngleUnit::Radians;
}

/// The command that decides the samples' file anew, as it was decided before it was written: with a
/// finer resolution than the path.
std::string check_command(const MoveOptions& o) {
  std::string out = "kaboum-check " + shell_file(o.scene);
  const auto add = [&out](const char* option, const std::string& value) {
    out += std::string(" --") + option + "=" + shell_word(value);
  };
  if (!o.robot.empty()) add("robot", o.robot);
  add("path", o.trajectory);
  if (motion::message_format(o.trajectory)) add("between", "quintic");
  if (o.degrees) out += " --degrees";
  for (const auto& [names, margin] : o.margin.margins)
    add("margin", (names.empty() ? "" : names + "=") + margin.text());
  for (const std::string& keep : o.keep.keep) add("keep", keep);
  if (!o.keep.tool.empty()) add("tool", o.keep.tool);
  add("resolution", number_text(1e-3 * o.search.check.resolution));
  add("max-intervals", "1000000000");
  return out;
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
  const bool is_file = o.trajectory != "-";
  const std::string check = is_file ? check_command(o) : "";
  if (is_file) report["check"] = check;
  const auto format = motion::message_format(o.trajectory);
  std::ostringstream summary;
  summary << o.trajectory << ": " << made.trajectory.samples() << " samples in "
          << made.trajectory.duration() << " s";
  if (is_file) summary << "; what decides it anew: " << check;
  return {
      format ? to_joint_trajectory(made.trajectory, r.kinematics(), *format) : std::move(made.csv),
      summary.str(), std::move(report)};
}

}  // namespace kaboum::tools
