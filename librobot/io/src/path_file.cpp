// Paths as files: what could be read in two ways is refused.

#include <kaboum/robot/path_file.h>

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

namespace kaboum::robot {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// The text from the first to the last character that is not blank.
std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// Whether every field of a line is the name of a joint.
bool all_names(std::string_view line, const Robot& robot) {
  const std::string_view separators =
      line.find_first_of(",;") == std::string_view::npos ? kBlanks : ",;";
  for (line = trimmed(line); !line.empty();) {
    const std::size_t end = std::min(line.find_first_of(separators), line.size());
    std::string_view field = trimmed(line.substr(0, end));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    if (std::none_of(robot.variables.begin(), robot.variables.end(),
                     [&](const auto& variable) { return variable.name == field; }))
      return false;
    line = trimmed(line.substr(std::min(end + 1, line.size())));
  }
  return true;
}

/// Whether the character may be within a name: a letter, digit, '_' or '-', one beyond ASCII, or
/// the point of a number.
bool in_word(std::string_view text, std::size_t at) {
  const auto digit = [&](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  if (at >= text.size()) return false;
  const auto c = static_cast<unsigned char>(text[at]);
  if (c == '.') return at > 0 && digit(at - 1) && digit(at + 1);
  return std::isalnum(c) != 0 || c == '_' || c == '-' || c >= 0x80;
}

/// The joints that a text names, in the order in which it first does; other words, units and
/// brackets are passed over. Of names that begin alike the longest counts.
std::vector<std::size_t> joints_in(std::string_view text, const Robot& robot) {
  std::vector<std::size_t> result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t longest = 0, joint = 0;
    const bool within = at > 0 && in_word(text, at - 1) && in_word(text, at);
    for (std::size_t j = 0; j < robot.variables.size() && !within; ++j) {
      const std::string& name = robot.variables[j].name;
      if (name.size() > longest && text.substr(at).starts_with(name) &&
          !in_word(text, at + name.size())) {
        longest = name.size();
        joint = j;
      }
    }
    if (longest > 0 && std::find(result.begin(), result.end(), joint) == result.end())
      result.push_back(joint);
    at += std::max<std::size_t>(longest, 1);
  }
  return result;
}

/// @param path  as parsed: whether a first line named the joints
void require_one_reading(std::string_view text, const NamedPath& path, const Robot& robot,
                         const std::string& name) {
  if (!path.joints.empty()) return;
  const auto refuse = [&](std::size_t line, const std::string& what) {
    throw Error(ErrorCode::InvalidInput, name + ": line " + std::to_string(line) + ": " + what);
  };
  std::istringstream lines{std::string(text)};
  std::size_t number = 0;
  bool numbers = false;
  for (std::string line; !numbers && std::getline(lines, line);) {
    ++number;
    const std::size_t comment = std::min(line.find('#'), line.size());
    const std::string_view before = trimmed(std::string_view(line).substr(0, comment));
    numbers = !before.empty();
    if (numbers && all_names(before, robot))
      refuse(number,
             "these numbers are also names of joints; write the path as JSON, with \"joints\"");
    const std::vector<std::size_t> named = joints_in(std::string_view(line).substr(comment), robot);
    if (!std::is_sorted(named.begin(), named.end()))
      refuse(number,
             "a comment names joints in another order than the robot's; if it is that of the "
             "columns, write a first line of these names alone, without #");
  }
}

}  // namespace

Path read_path(const std::string& file, const Robot& robot, const PathOptions& options,
               std::vector<std::string>& notes) {
  const std::vector<char> bytes = io::read_file(file);
  std::string_view text(bytes.data(), bytes.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  const std::string name = file == "-" ? "standard input" : file;
  const bool json = start != std::string_view::npos && (text[start] == '{' || text[start] == '[');
  const NamedPath path =
      json ? robot::parse_path_json(text, name) : robot::parse_path_csv(text, name);
  if (!json) require_one_reading(text, path, robot, name);
  for (const std::size_t column : robot::time_columns(path, robot))
    notes.push_back(name + ": the column '" + path.joints[column] +
                    "' is passed over: what is swept does not depend on times");
  Path result = robot::arrange(path, robot, name, false, options.fixed);
  if (options.degrees) result = robot::from_degrees(std::move(result), robot);
  if (options.check_limits) robot::require_within_limits(result, robot, name);
  if (const auto found = robot::find_likely_degrees(result, robot)) {
    std::ostringstream warning;
    warning << "WARNING: " << name << ": ";
    if (found->waypoint < path.lines.size())
      warning << "line " << path.lines[found->waypoint] << ", ";
    warning << "waypoint " << found->waypoint + 1 << ": joint '"
            << robot.variables[found->variable].name << "' at "
            << result[found->waypoint][found->variable] << " radians is turned more than twice; "
            << (options.degrees ? "are the values degrees?"
                                : "if these are degrees, give «degrees»");
    notes.push_back(warning.str());
  }
  return result;
}

std::string largest_move(const Path& path, const Robot& robot) {
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

}  // namespace kaboum::robot
