// Paths as files: what could be read in two ways is refused.

#include <kaboum/robot/path_file.h>

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/number_array.h>
#include <kaboum/robot/path_derivatives.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#ifdef KABOUM_HAS_YAML
#include <yaml-cpp/yaml.h>
#endif

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

/// Whether a text is YAML: by its file's name, or by a first line as trajectories begin with.
bool is_yaml(std::string_view text, const std::string& file) {
  if (file.ends_with(".yaml") || file.ends_with(".yml")) return true;
  while (true) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (line == "---") return true;
    const bool passed_over = line.empty() || line.starts_with('#');
    if (!passed_over || end == text.size()) {
      for (const std::string_view key :
           {"header:", "joint_names:", "points:", "joint_trajectory:", "trajectory:", "model_id:",
            "trajectory_start:", "goal:", "joints:", "waypoints:", "position:", "positions:"})
        if (line.starts_with(key)) return true;
      return false;
    }
    text.remove_prefix(end + 1);
  }
}

#ifdef KABOUM_HAS_YAML

using Json = nlohmann::json;

/// What a plain scalar says: a number where all of it is one.
Json scalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // in quotation marks
  double number = 0;
  const char *begin = text.data(), *end = begin + text.size();
  if (text.starts_with('+')) ++begin;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (begin != end && error == std::errc() && stop == end && std::isfinite(number)) return number;
  return text;
}

/// @param left  how many values there may be: aliases stand for what is elsewhere, again and again
Json to_json(const YAML::Node& node, const std::string& name, std::size_t& left, int depth = 0) {
  constexpr int kDeepest = 32;
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput,
                name + ": line " + std::to_string(node.Mark().line + 1) + ": " + what);
  };
  if (depth > kDeepest) refuse("nested too deep");
  if (left-- == 0) refuse("aliases stand for far more than is written out");
  if (node.IsSequence()) {
    Json out = Json::array();
    for (const YAML::Node& item : node) out.push_back(to_json(item, name, left, depth + 1));
    return out;
  }
  if (node.IsMap()) {
    Json out = Json::object();
    for (const auto& member : node) {
      if (!member.first.IsScalar()) refuse("a name is expected");
      const std::string& key = member.first.Scalar();
      if (out.contains(key)) refuse("'" + key + "' is there twice");
      out[key] = to_json(member.second, name, left, depth + 1);
    }
    return out;
  }
  if (node.IsScalar()) return scalar(node);
  return {};
}

/// A path in YAML, by the JSON that says the same. Documents without anything in them, as
/// `ros2 topic echo` ends messages with, are passed over.
NamedPath parse_path_yaml(std::string_view text, const std::string& name,
                          PathDerivatives& derivatives) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput, name + ": " + what);
  };
  const std::string whole(text);
  std::vector<YAML::Node> documents;
  try {
    for (YAML::Node& node : YAML::LoadAll(whole))
      if (!node.IsNull()) documents.push_back(node);
  } catch (const YAML::Exception& error) {
    refuse("line " + std::to_string(error.mark.line + 1) + ", column " +
           std::to_string(error.mark.column + 1) + ": not YAML: " + error.msg);
  }
  if (documents.empty()) refuse("nothing is in it; a path is expected");
  if (documents.size() > 1)
    refuse(std::to_string(documents.size()) +
           " documents (messages with --- between); put each into a file of its own");
  std::string json;
  try {
    std::size_t left = 16 * text.size();
    json = to_json(documents.front(), name, left).dump();
  } catch (const Json::exception&) {
    refuse("text that is not UTF-8");
  }
  return parse_path_json(json, name, derivatives);
}

#else

NamedPath parse_path_yaml(std::string_view /*text*/, const std::string& /*name*/,
                          PathDerivatives& /*derivatives*/) {
  throw Error(ErrorCode::NotBuilt, "paths in YAML need a build with yaml-cpp");
}

#endif

/// Rows of an array, a value for each joint that moves.
NamedPath path_of_array(const std::vector<char>& bytes, const Robot& robot,
                        const FixedJoints& fixed, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput, name + ": " + what);
  };
  const io::NumberArray array = io::parse_number_array(bytes, name);
  std::vector<std::size_t> shape = array.shape;
  // A batch of one, as planners on many problems have it.
  if (shape.size() == 3 && shape[0] == 1) shape.erase(shape.begin());
  if (shape.size() != 2)
    refuse(shape.size() == 3 ? "an array of three dimensions: " + std::to_string(shape[0]) +
                                   " paths; save each by itself: numpy.save(\"path.npy\", array[0])"
                             : "an array with a row for each configuration is expected");
  std::string names;
  std::size_t expected = 0;
  for (const Variable& v : robot.variables) {
    if (fixed.contains(v.name)) continue;
    names += (expected++ == 0 ? "" : ", ") + v.name;
  }
  if (shape[1] != expected)
    refuse(std::to_string(shape[1]) + " columns, and " + std::to_string(expected) +
           " are expected: " + names + ", in this order");
  NamedPath out;
  out.waypoints.reserve(shape[0]);
  for (std::size_t row = 0; row < shape[0]; ++row) {
    const auto begin = array.values.begin() + static_cast<std::ptrdiff_t>(row * shape[1]);
    const auto end = begin + static_cast<std::ptrdiff_t>(shape[1]);
    if (!std::all_of(begin, end, [](double x) { return std::isfinite(x); }))
      refuse("row " + std::to_string(row + 1) + ": a number that is not finite");
    out.waypoints.emplace_back(begin, end);
  }
  return out;
}

NamedPath parse_path(const std::vector<char>& bytes, const std::string& file, const Robot& robot,
                     const PathOptions& options, const std::string& name,
                     PathDerivatives& derivatives) {
  if (file.ends_with(".npz"))
    throw Error(ErrorCode::InvalidInput,
                name + ": an archive of arrays; save one array as .npy, with numpy.save");
  if (io::is_number_array(bytes)) return path_of_array(bytes, robot, options.fixed, name);
  std::string_view text(bytes.data(), bytes.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start != std::string_view::npos && (text[start] == '{' || text[start] == '['))
    return parse_path_json(text, name, derivatives);
  if (is_yaml(text, file)) return parse_path_yaml(text, name, derivatives);
  NamedPath out = parse_path_csv(text, name);
  require_one_reading(text, out, robot, name);
  return out;
}

}  // namespace

namespace {

/// Derivatives of the waypoints in the robot's order; those of fixed joints are 0. Empty: none are
/// stated.
/// @param rows  of PathDerivatives
Path arranged_derivatives(const NamedPath& path, Path rows, const char* what, const Robot& robot,
                          const PathOptions& options, const std::string& name) {
  const auto none = std::ranges::find_if(rows, [](const auto& row) { return row.empty(); });
  if (std::ranges::all_of(rows, [](const auto& row) { return row.empty(); })) return {};
  if (none != rows.end())
    throw Error(ErrorCode::InvalidInput, name + ": point " +
                                             std::to_string(none - rows.begin() + 1) + " has no " +
                                             what + ", a number for each joint, as others have");
  NamedPath named{path.joints, std::move(rows)};
  if (named.joints.size() > named.waypoints.front().size()) named.joints.pop_back();  // times
  FixedJoints still;
  for (const auto& [joint, value] : options.fixed) still[joint] = 0;
  Path out = robot::arrange(named, robot, name, false, still);
  return options.degrees ? robot::from_degrees(std::move(out), robot) : out;
}

bool is_any_not_zero(const Path& rows) {
  return std::ranges::any_of(rows, [](const std::vector<double>& row) {
    return std::ranges::any_of(row, [](double x) { return x != 0; });
  });
}

/// @param uses_times  else a note says that they are passed over
/// @param derivatives  as of read_timed_path
TimedPath read_arranged(const std::string& file, const Robot& robot, const PathOptions& options,
                        bool uses_times, bool derivatives, std::vector<std::string>& notes) {
  const std::string name = file == "-" ? "standard input" : file;
  PathDerivatives stated;
  const NamedPath path = parse_path(io::read_file(file), file, robot, options, name, stated);
  if (!uses_times)
    for (const std::size_t column : robot::time_columns(path, robot))
      notes.push_back(name + ": the column '" + path.joints[column] +
                      "' is passed over: what is swept does not depend on times");
  notes.insert(notes.end(), path.notes.begin(), path.notes.end());
  TimedPath out;
  if (derivatives) {
    if (!stated.unfit.empty())
      throw Error(ErrorCode::InvalidInput,
                  name + ": " + stated.unfit + ": a number for each joint is expected");
    out.velocities =
        arranged_derivatives(path, stated.velocities, "velocities", robot, options, name);
    out.accelerations =
        arranged_derivatives(path, stated.accelerations, "accelerations", robot, options, name);
  } else if (!stated.unfit.empty() || is_any_not_zero(stated.velocities) ||
             is_any_not_zero(stated.accelerations)) {
    notes.push_back(name +
                    ": velocities and accelerations are passed over: between points, joints move "
                    "straight; a controller that makes splines of them leaves that" +
                    (uses_times ? " («between» decides these)" : ""));
  }
  Path& result = out.waypoints;
  result = robot::arrange(path, robot, name, false, options.fixed);
  out.times = robot::times_of(path, robot);
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
  return out;
}

}  // namespace

TimedPath read_timed_path(const std::string& file, const Robot& robot, const PathOptions& options,
                          std::vector<std::string>& notes, bool derivatives) {
  return read_arranged(file, robot, options, true, derivatives, notes);
}

Path read_path(const std::string& file, const Robot& robot, const PathOptions& options,
               std::vector<std::string>& notes) {
  return read_arranged(file, robot, options, false, false, notes).waypoints;
}

Path parse_configuration(const std::string& text, const std::string& name, const Robot& robot,
                         const PathOptions& options) try {
  const NamedPath named = parse_path_csv(text, name);
  const std::size_t given = named.waypoints.front().size() + options.fixed.size(),
                    needed = robot.variables.size();
  if (named.joints.empty() && (named.waypoints.size() > 1 || given != needed)) {
    std::string names;
    for (const Variable& v : robot.variables) names += (names.empty() ? "" : ",") + v.name;
    throw Error(ErrorCode::InvalidArgument,
                name + ": " + std::to_string(needed) + " values are expected, one for each of " +
                    names + (given == needed ? ", on one line" : ", not " + std::to_string(given)));
  }
  Path path = arrange(named, robot, name, false, options.fixed);
  if (options.degrees) path = from_degrees(std::move(path), robot);
  if (options.check_limits) require_within_limits(path, robot, name);
  return path;
} catch (const Error& error) {  // the command line's fault, no file's
  throw Error(ErrorCode::InvalidArgument, error.what());
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
