// What to do next with a robot that was written.

#include "next_steps.h"

#include "common/shell_word.h"

namespace kaboum::tools {
namespace {

using Format = robot::RobotFile::Format;

/// Words on what has to come first; empty: nothing.
std::string first(bool needed, const std::string& options, const std::string& then) {
  if (!needed) return then;
  return "first the same command with " + options + (then.empty() ? "" : "; " + then);
}

}  // namespace

std::vector<page::Step> next_steps(const robot_folder::RobotWriter& writer,
                                   const RobotOptions& options, const RobotCheck& check,
                                   std::optional<bool> srdf) {
  const std::filesystem::path robot = writer.folder().urdf();
  const auto named = [&](const char* extension) {
    std::filesystem::path other = robot;
    return shell_word(other.replace_extension(extension).string());
  };
  const auto not_for = [&](const char* program) { return options.preset != program; };
  const std::string itself = shell_word(robot.string());
  std::vector<page::Step> out{
      {"check it",
       std::string("from the files alone") + (check.passes ? "" : ", with an exit code above 0"),
       check.command}};
  // Isaac takes the hull of each mesh, with so many vertices.
  const auto isaac = [&](const char* script) {
    if (!srdf) return;
    out.push_back({"Isaac Lab", "in its folder, with whole paths",
                   "./isaaclab.sh -p scripts/tools/" + std::string(script) + " " + itself + " " +
                       named(".usd")});
  };
  switch (writer.robot().format) {
    case Format::Urdf:
    case Format::Rl:
      out.push_back(
          {"MoveIt",
           srdf ? first(not_for("moveit") || !*srdf, "--for moveit --srdf",
                        "the assistant loads " + itself + "; " + named(".srdf") +
                            " has the pairs of links that need no check")
                : first(not_for("moveit"), "--for moveit", "the assistant loads " + itself),
           "ros2 launch moveit_setup_assistant setup_assistant.launch.py"});
      out.push_back({"MuJoCo", first(not_for("mujoco"), "--for mujoco", ""),
                     "python3 -m mujoco.viewer --mjcf=" + named(".xml")});
      out.push_back({"Drake", first(not_for("drake"), "--for drake", ""),
                     "python3 -m pydrake.visualization.model_visualizer " + itself});
      isaac("convert_urdf.py");
      out.push_back(
          {"Gazebo", first(not_for("gazebo"), "--for gazebo", ""), "gz sim " + named(".sdf")});
      break;
    case Format::Mjcf:
      out.push_back({"MuJoCo", "", "python3 -m mujoco.viewer --mjcf=" + itself});
      out.push_back({"Drake", "", "python3 -m pydrake.visualization.model_visualizer " + itself});
      isaac("convert_mjcf.py");
      break;
    case Format::Sdf:
      out.push_back({"Gazebo", "", "gz sim " + itself});
      out.push_back({"Drake", "", "python3 -m pydrake.visualization.model_visualizer " + itself});
      out.push_back({"MuJoCo", first(!options.writes("mjcf"), "--robot-format mjcf", ""),
                     "python3 -m mujoco.viewer --mjcf=" + named(".xml")});
      break;
  }
  return out;
}

}  // namespace kaboum::tools
