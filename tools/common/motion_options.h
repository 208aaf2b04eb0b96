#pragma once

#include <kaboum/robot/path.h>

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace kaboum::tools {

/// Adds the option --joint NAME=VALUE, which may be repeated.
CLI::Option* add_joint_option(CLI::App& app, std::vector<std::string>& values);
/// Adds the flag --degrees.
CLI::Option* add_degrees_option(CLI::App& app, bool& degrees);
/// Adds the option --base-pose.
CLI::Option* add_base_option(CLI::App& app, std::string& value);
/// @throws Error{InvalidArgument} on what is not NAME=VALUE, and on joints given twice.
robot::FixedJoints fixed_joints(const std::vector<std::string>& values);

}  // namespace kaboum::tools
