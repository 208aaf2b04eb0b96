// Paths of joint values from text, and what their columns mean.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

namespace kaboum::robot {
namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, name + ": " + what);
}

constexpr std::string_view kBlanks = " \t\r";

struct Field {
  std::string text;
  bool quoted = false;  ///< a name, whatever it looks like
};

/// Where a field ends that begins with a quotation mark: past the closing one; two of them stand
/// for one. npos: there is none.
std::size_t end_of_quoted(std::string_view line) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] != '"') continue;
    if (i + 1 == line.size() || line[i + 1] != '"') return i + 1;
    ++i;
  }
  return std::string_view::npos;
}

std::string unquoted(std::string_view field) {
  std::string out;
  for (std::size_t i = 1; i + 1 < field.size(); ++i) {
    out += field[i];
    if (field[i] == '"') ++i;
  }
  return out;
}

/// Without what follows a '#' outside quotation marks.
std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted) return line.substr(0, i);
  }
  return quoted ? line.substr(0, line.find('#')) : line;
}

/// Whether fields are separated by commas or semicolons.
bool has_separators(std::string_view line) {
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == ',' || c == ';')) return true;
  }
  return quoted && line.find_first_of(",;") != std::string_view::npos;
}

/// Fields between commas or semicolons, without the blanks and quotation marks round them, the last
/// one perhaps ended by a separator; else words between blanks.
std::vector<Field> split(std::string_view line) {
  const bool commas = has_separators(line);
  const std::string_view ends = commas ? ",;" : kBlanks;
  std::vector<Field> out;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    std::size_t from = 0;
    if (line.starts_with('"')) {
      const std::size_t closed = end_of_quoted(line);
      if (closed != std::string_view::npos) from = closed;
    }
    const std::size_t end = std::min(line.find_first_of(ends, from), line.size());
    std::string_view field = line.substr(0, end);
    field = field.substr(0, field.find_last_not_of(kBlanks) + 1);
    const bool last = end == line.size(), quoted = from > 0 && field.size() == from;
    if (last && commas && field.empty() && !out.empty()) return out;
    if (commas || !field.empty())
      out.push_back({quoted ? unquoted(field) : std::string(field), quoted});
    if (last) return out;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number(const std::string& text) {
  double value = 0;
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || begin == end) return std::nullopt;
  return value;
}

void append(NamedPath& path, std::vector<double> waypoint, const std::string& name,
            const std::string& place) {
  const std::size_t expected =
      !path.joints.empty()
          ? path.joints.size()
          : (path.waypoints.empty() ? waypoint.size() : path.waypoints.front().size());
  if (waypoint.size() != expected)
    fail(name, place + ": " + std::to_string(waypoint.size()) + " numbers instead of " +
                   std::to_string(expected));
  for (const double x : waypoint)
    if (!std::isfinite(x)) fail(name, place + ": a number that is not finite");
  path.waypoints.push_back(std::move(waypoint));
}

bool has_variable(const Robot& robot, const std::string& name) {
  return std::any_of(robot.variables.begin(), robot.variables.end(),
                     [&](const Variable& v) { return v.name == name; });
}

std::string beyond_limits(const Variable& joint, double value) {
  const auto text = [](double x) {
    std::ostringstream out;
    out << x;
    return out.str();
  };
  const auto limit = [&](const std::optional<double>& x, const char* none) {
    return x ? text(*x) : none;
  };
  return "joint '" + joint.name + "' at " + text(value) + " is outside its limits, " +
         limit(joint.lower, "-inf") + " to " + limit(joint.upper, "inf") +
         " (radians, or metres where it slides; «degrees» if it is in degrees)";
}

/// @param times  the columns
void require_times_in_order(const NamedPath& path, const std::vector<std::size_t>& times,
                            const std::string& name) {
  for (std::size_t w = 1; w < path.waypoints.size(); ++w)
    for (const std::size_t column : times) {
      const double before = path.waypoints[w - 1][column], time = path.waypoints[w][column];
      if (time >= before) continue;
      std::ostringstream text;
      text.precision(17);
      if (w < path.lines.size())
        text << "line " << path.lines[w];
      else
        text << "waypoint " << w + 1;
      text << ", column " << column + 1 << ": " << path.joints[column] << " " << time
           << " is before " << before
           << " of the waypoint above; put the waypoints in their order (several recordings: in "
              "files of their own), or take the column out";
      fail(name, text.str());
    }
}

}  // namespace

NamedPath parse_path_csv(std::string_view text, const std::string& name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const auto is_binary = [](char c) { return (c >= 0 && c < '\t') || (c > '\r' && c < ' '); };
  if (std::any_of(text.begin(), text.end(), is_binary))
    fail(name, "not a text file; a path is CSV or JSON: joint values, a line for each waypoint");
  NamedPath path;
  bool first = true;
  std::size_t line_number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    const std::vector<Field> fields = split(without_comment(line));
    if (fields.empty()) continue;
    const std::string place = "line " + std::to_string(line_number);
    std::vector<double> values;
    std::string bad;
    const bool names =
        first && std::any_of(fields.begin(), fields.end(), [](const Field& f) { return f.quoted; });
    for (const Field& field : fields) {
      const auto value = names && field.quoted ? std::nullopt : number(field.text);
      if (value)
        values.push_back(*value);
      else
        bad = field.text;
    }
    if (values.size() < fields.size()) {
      if (!first) fail(name, place + ": '" + bad.substr(0, 40) + "' is not a number");
      if (!values.empty())
        fail(name, place + ": names of joints and numbers in one line ('" + bad.substr(0, 40) +
                       "' is not a number)");
      for (const Field& field : fields) {
        if (field.text.empty()) fail(name, place + ": a joint without a name");
        path.joints.push_back(field.text);
      }
    } else {
      append(path, std::move(values), name, place);
      path.lines.push_back(line_number);
    }
    first = false;
  }
  if (path.waypoints.empty()) fail(name, "no waypoint: write one line of numbers for each");
  return path;
}

NamedPath parse_path_json(std::string_view text, const std::string& name) {
  // Depth is limited before anything is built.
  Json json;
  try {
    json = Json::parse(text, [](int depth, Json::parse_event_t, Json&) { return depth <= 8; });
  } catch (const Json::parse_error& e) {
    fail(name, describe_json_damage(text, e.byte) + "; mend the path there");
  } catch (const Json::exception&) {
    fail(name, "a number in it is out of range");
  }
  if (json.is_discarded()) fail(name, "it is nested too deep; write a list of waypoints");
  NamedPath path;
  const Json* waypoints = &json;
  if (json.is_object()) {
    if (!json.contains("waypoints")) fail(name, "no \"waypoints\"");
    waypoints = &json["waypoints"];
    if (json.contains("joints")) {
      const Json& joints = json["joints"];
      if (!joints.is_array()) fail(name, "\"joints\" is not a list of names");
      for (const Json& joint : joints) {
        if (!joint.is_string()) fail(name, "\"joints\" is not a list of names");
        path.joints.push_back(joint.get<std::string>());
      }
    }
  }
  if (!waypoints->is_array()) fail(name, "the waypoints are not a list");
  for (const Json& row : *waypoints) {
    const std::string place = "waypoint " + std::to_string(path.waypoints.size() + 1);
    if (!row.is_array()) fail(name, place + " is not a list of numbers");
    std::vector<double> values;
    for (const Json& x : row) {
      if (!x.is_number()) fail(name, place + " is not a list of numbers");
      values.push_back(x.get<double>());
    }
    append(path, std::move(values), name, place);
  }
  if (path.waypoints.empty()) fail(name, "no waypoint");
  return path;
}

std::string csv_field(const std::string& joint) {
  const bool plain = !number(joint) && joint.find_first_of(",;#\" \t\r\n") == std::string::npos;
  if (plain) return joint;
  std::string out = "\"";
  for (const char c : joint) out += c == '"' ? std::string(2, c) : std::string(1, c);
  return out + '"';
}

std::vector<std::size_t> time_columns(const NamedPath& path, const Robot& robot) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    std::string name = path.joints[i];
    if (has_variable(robot, name)) continue;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    for (const char* time :
         {"time", "%time", "__time", "timestamp", "stamp", "time_from_start", "t"})
      if (name == time) out.push_back(i);
  }
  return out;
}

Path arrange(const NamedPath& path, const Robot& robot, const std::string& name, bool check_limits,
             const FixedJoints& fixed) {
  const std::size_t count = robot.variables.size();
  const auto none = [&](const std::string& joint) {
    std::vector<std::string> known;
    for (const Variable& v : robot.variables) known.push_back(v.name);
    return "the robot has no joint '" + joint +
           "' that moves by itself (fixed and mimicking joints have no column)" +
           did_you_mean(joint, known);
  };
  for (const auto& [joint, value] : fixed) {
    if (!has_variable(robot, joint)) throw Error(ErrorCode::InvalidArgument, none(joint));
    if (std::find(path.joints.begin(), path.joints.end(), joint) != path.joints.end())
      throw Error(ErrorCode::InvalidArgument, std::string(name)
                                                  .append(": joint '")
                                                  .append(joint)
                                                  .append("' has a column and a value besides"));
  }
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> column(count, kNone);
  if (path.joints.empty()) {
    const std::size_t moving = count - fixed.size();
    // Joints may have numbers for names; taken for a waypoint, they would move the robot.
    const std::vector<double>& head = path.waypoints.front();
    bool are_names = head.size() == count && count > 0;
    for (std::size_t i = 0; are_names && i < count; ++i)
      are_names = number(robot.variables[i].name) == head[i];
    if (are_names)
      fail(name,
           "the first line may be the names of the joints or a waypoint: put quotation marks round "
           "the names, or add a line of names if it is a waypoint");
    if (path.waypoints.front().size() != moving)
      fail(name, std::to_string(path.waypoints.front().size()) + " columns for a robot with " +
                     std::to_string(moving) + (fixed.empty() ? "" : " other") +
                     " joints; name the joints in the first line");
    for (std::size_t i = 0, next = 0; i < count; ++i)
      if (!fixed.contains(robot.variables[i].name)) column[i] = next++;
  } else {
    const std::vector<std::size_t> times = time_columns(path, robot);
    for (std::size_t j = 0; j < path.joints.size(); ++j) {
      const std::string& joint = path.joints[j];
      if (std::find(times.begin(), times.end(), j) != times.end()) continue;
      if (std::count(path.joints.begin(), path.joints.end(), joint) > 1)
        fail(name, "joint '" + joint + "' is named twice");
      if (!has_variable(robot, joint)) fail(name, none(joint));
    }
    require_times_in_order(path, times, name);
    for (std::size_t i = 0; i < count; ++i) {
      const std::string& joint = robot.variables[i].name;
      if (fixed.contains(joint)) continue;
      const auto it = std::find(path.joints.begin(), path.joints.end(), joint);
      if (it == path.joints.end())
        fail(name, std::string("no column for joint '")
                       .append(joint)
                       .append("'; where it does not move, give its value instead («joint=")
                       .append(joint)
                       .append("=0»)"));
      column[i] = static_cast<std::size_t>(it - path.joints.begin());
    }
  }
  Path out;
  for (const std::vector<double>& row : path.waypoints) {
    std::vector<double> q(count);
    for (std::size_t i = 0; i < count; ++i)
      q[i] = column[i] == kNone ? fixed.at(robot.variables[i].name) : row[column[i]];
    out.push_back(std::move(q));
  }
  if (check_limits) require_within_limits(out, robot, name);
  return out;
}

void require_within_limits(const Path& path, const Robot& robot, const std::string& name) {
  for (std::size_t w = 0; w < path.size(); ++w)
    if (const auto bad = find_out_of_limits(robot, path[w]))
      fail(name, "waypoint " + std::to_string(w + 1) + ": " +
                     beyond_limits(robot.variables[*bad], path[w][*bad]));
}

bool is_angle(const Robot& robot, const Variable& variable) {
  return std::any_of(robot.joints.begin(), robot.joints.end(), [&](const Joint& joint) {
    return joint.name == variable.name && joint.type == JointType::Revolute;
  });
}

Path from_degrees(Path path, const Robot& robot) {
  for (std::size_t i = 0; i < robot.variables.size(); ++i)
    if (is_angle(robot, robot.variables[i]))
      for (std::vector<double>& q : path) q[i] *= std::numbers::pi / 180;
  return path;
}

Path to_degrees(Path path, const Robot& robot) {
  constexpr double kDegree = std::numbers::pi / 180,
                   kInfinite = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < robot.variables.size(); ++i) {
    const Variable& variable = robot.variables[i];
    if (!is_angle(robot, variable)) continue;
    const double lower = variable.lower.value_or(-kInfinite),
                 upper = variable.upper.value_or(kInfinite);
    for (std::vector<double>& q : path) {
      const double radians = q[i];
      const double quotient = radians / kDegree;
      // What reads back as it was, if one of these does, the plainest first.
      double degrees = quotient;
      for (const double x :
           {std::round(quotient * 1e10) / 1e10, quotient, std::nextafter(quotient, kInfinite),
            std::nextafter(quotient, -kInfinite)})
        if (x * kDegree == radians) {
          degrees = x;
          break;
        }
      while (radians >= lower && degrees * kDegree < lower)
        degrees = std::nextafter(degrees, kInfinite);
      while (radians <= upper && degrees * kDegree > upper)
        degrees = std::nextafter(degrees, -kInfinite);
      q[i] = degrees;
    }
  }
  return path;
}

std::optional<LikelyDegrees> find_likely_degrees(const Path& path, const Robot& robot) {
  for (std::size_t w = 0; w < path.size(); ++w)
    for (std::size_t i = 0; i < robot.variables.size(); ++i)
      if (std::abs(path[w][i]) > 4 * std::numbers::pi && is_angle(robot, robot.variables[i]))
        return LikelyDegrees{w, i};
  return std::nullopt;
}

}  // namespace kaboum::robot
