#include "robot_path.h"

#include <kaboum/geom/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace kaboum::tools {
namespace {

/// The columns' variables of the robot, if every field of a line names one.
std::vector<std::size_t> named(std::string line, const sweep::Robot& robot) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  std::istringstream fields(line);
  std::vector<std::size_t> result;
  for (std::string field; fields >> field;) {
    const auto at = std::find_if(robot.variables.begin(), robot.variables.end(),
                                 [&](const auto& variable) { return variable.name == field; });
    if (at == robot.variables.end()) return {};
    result.push_back(static_cast<std::size_t>(at - robot.variables.begin()));
  }
  return result;
}

/// @param path  as parsed: whether a first line named the joints
void require_one_reading(std::string_view text, const sweep::NamedPath& path,
                         const sweep::Robot& robot, const std::string& name) {
  if (!path.joints.empty()) return;
  const auto refuse = [&](std::size_t line, const std::string& what) {
    throw Error(ErrorCode::InvalidInput, name + ": line " + std::to_string(line) + ": " + what);
  };
  std::istringstream lines{std::string(text)};
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t comment = line.find('#');
    const std::string before = line.substr(0, comment);
    if (before.find_first_not_of(" \t\r") != std::string::npos) {
      if (!named(before, robot).empty())
        refuse(number,
               "these numbers are also names of joints; write the path as JSON, with \"joints\"");
      return;
    }
    if (comment == std::string::npos) continue;
    const std::vector<std::size_t> columns = named(line.substr(comment + 1), robot);
    if (!std::is_sorted(columns.begin(), columns.end()))
      refuse(number,
             "a comment names joints in another order than the robot's; without the # it is the "
             "order of the columns");
  }
}

}  // namespace

sweep::Path read_path(const std::string& file, const sweep::Robot& robot, bool check_limits) {
  const std::vector<char> bytes = io::read_file(file);
  const std::string_view text(bytes.data(), bytes.size());
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  const std::string name = file == "-" ? "standard input" : file;
  if (start != std::string_view::npos && (text[start] == '{' || text[start] == '['))
    return sweep::arrange(sweep::parse_path_json(text, name), robot, name, check_limits);
  const sweep::NamedPath path = sweep::parse_path_csv(text, name);
  require_one_reading(text, path, robot, name);
  return sweep::arrange(path, robot, name, check_limits);
}

std::string largest_move(const sweep::Path& path, const sweep::Robot& robot) {
  double largest = 0;
  std::ostringstream text;
  for (std::size_t w = 1; w < path.size(); ++w)
    for (std::size_t j = 0; j < path[w].size(); ++j)
      if (const double move = std::abs(path[w][j] - path[w - 1][j]); move > largest) {
        largest = move;
        text.str({});
        text << "joint '" << robot.variables[j].name << "' moves most, by " << move
             << " to waypoint " << w + 1;
      }
  return text.str();
}

}  // namespace kaboum::tools
