// Paths of joint values from text, and what their columns mean.

#include <kaboum/base/error.h>
#include <kaboum/base/read_json.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path.h>
#include <kaboum/robot/path_derivatives.h>

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
      path.joints_at = place;
    } else {
      append(path, std::move(values), name, place);
      path.lines.push_back(line_number);
    }
    first = false;
  }
  if (path.waypoints.empty()) fail(name, "no waypoint: write one line of numbers for each");
  return path;
}

namespace {

/// A trajectory in JSON as other programs have it. Of their members those are looked at that say
/// where joints are, and when.
class TrajectoryReader {
 public:
  TrajectoryReader(const std::string& name, PathDerivatives& derivatives)
      : name_(name), derivatives_(derivatives) {}

  /// @param at  where the value is, for messages; empty: all of the file
  NamedPath read(const Json& value, const std::string& at) {
    if (value.is_array()) {
      if (value.empty() || !value.front().is_object()) return read_rows(value, at);
      if (value.size() > 1)
        refuse(at, std::to_string(value.size()) + " trajectories; put each into a file of its own");
      return read(value.front(), at);
    }
    if (!value.is_object()) refuse(at, "a trajectory is expected");
    if (value.contains("waypoints")) return read_waypoints(value, at);
    if (value.contains("points")) return read_points(value, at);
    for (const char* position : {"position", "positions"})
      if (value.contains(position)) return read_positions(value, position, at);
    return read_within(value, at);
  }

 private:
  [[noreturn]] void refuse(const std::string& at, const std::string& what) const {
    fail(name_, (at.empty() ? "" : at + ": ") + what);
  }
  static std::string member(const std::string& at, const std::string& name) {
    return at.empty() ? name : at + "." + name;
  }

  std::vector<double> numbers(const Json& row, const std::string& at) const {
    const char* what = "not a list of numbers";
    if (!row.is_array()) refuse(at, what);
    std::vector<double> out;
    for (const Json& x : row) {
      if (x.is_string() && x.get<std::string>() == "...")
        refuse(at,
               "it was cut short when it was printed: print the message with all of its values");
      if (!x.is_number()) refuse(at, what);
      out.push_back(x.get<double>());
    }
    return out;
  }

  NamedPath read_rows(const Json& rows, const std::string& at) const {
    NamedPath out;
    add_rows(rows, at, out);
    return out;
  }

  void add_rows(const Json& rows, const std::string& at, NamedPath& out) const {
    if (!rows.is_array()) refuse(at, "the waypoints are not a list");
    for (const Json& row : rows) {
      const std::string place =
          (at.empty() ? "" : at + ": ") + "waypoint " + std::to_string(out.waypoints.size() + 1);
      append(out, numbers(row, place), name_, place);
    }
    if (out.waypoints.empty()) refuse(at, "no waypoint");
  }

  std::vector<std::string> names(const Json& value, const std::string& at) const {
    std::vector<std::string> out;
    if (!value.is_array()) refuse(at, "not a list of names");
    for (const Json& joint : value) {
      if (!joint.is_string()) refuse(at, "not a list of names");
      out.push_back(joint.get<std::string>());
    }
    return out;
  }

  /// What this project writes.
  NamedPath read_waypoints(const Json& value, const std::string& at) const {
    NamedPath out;
    if (value.contains("joints")) {
      out.joints_at = member(at, "joints");
      out.joints = names(value["joints"], out.joints_at);
    }
    add_rows(value["waypoints"], at, out);
    return out;
  }

  /// A trajectory or more in a message of ROS or MoveIt.
  NamedPath read_within(const Json& value, const std::string& at) {
    require_no_other_joints(value, at);
    if (value.contains("trajectory_start")) note_start(value["trajectory_start"]);
    for (const char* inner : {"joint_trajectory", "trajectory", "goal", "planned_trajectory"})
      if (value.contains(inner) && !value[inner].is_null())
        return read(value[inner], member(at, inner));
    refuse(
        at,
        "no \"waypoints\", \"points\" or \"position\" (a path, a JointTrajectory or a JointState)");
  }

  /// Of MoveIt's trajectories: planar and floating joints.
  void require_no_other_joints(const Json& value, const std::string& at) const {
    const char* key = "multi_dof_joint_trajectory";
    if (!value.contains(key) || !value[key].is_object()) return;
    const Json& other = value[key];
    for (const char* part : {"points", "joint_names"})
      if (other.contains(part) && other[part].is_array() && !other[part].empty())
        refuse(member(at, key),
               "joints of several degrees of freedom move; only such of one are known here");
  }

  void note_start(const Json& start) {
    if (!start.is_object()) return;
    const char* key = "attached_collision_objects";
    if (start.contains(key) && start[key].is_array() && !start[key].empty())
      notes_.push_back("WARNING: " + name_ +
                       ": \"trajectory_start\" has objects that are carried; they are passed over, "
                       "and what the scene has is looked at");
  }

  /// ROS's JointTrajectory.
  NamedPath read_points(const Json& value, const std::string& at) {
    NamedPath out;
    out.joints_at = member(at, "joint_names");
    if (!value.contains("joint_names"))
      refuse(at, "no \"joint_names\" beside \"points\": whose values they are is not known");
    out.joints = names(value["joint_names"], out.joints_at);
    const Json& points = value["points"];
    if (!points.is_array()) refuse(member(at, "points"), "not a list");
    if (points.empty()) refuse(member(at, "points"), "no points: the trajectory is empty");
    const bool timed = points.front().is_object() && points.front().contains("time_from_start");
    if (timed) out.joints.emplace_back("time_from_start");
    std::size_t number = 0;
    for (const Json& point : points) {
      const std::string place = member(at, "points") + ": point " + std::to_string(++number);
      if (!point.is_object() || !point.contains("positions"))
        refuse(place, "no \"positions\"; an effort or a velocity alone is no place");
      std::vector<double> row = numbers(point["positions"], place + ", positions");
      if (row.size() + (timed ? 1 : 0) != out.joints.size())
        refuse(place + ", positions", std::to_string(row.size()) + " numbers instead of " +
                                          std::to_string(out.joints.size() - (timed ? 1 : 0)) +
                                          ", one for each of " + out.joints_at);
      if (point.contains("time_from_start") != timed)
        refuse(place, "some points have a \"time_from_start\", others have none");
      if (timed) row.push_back(seconds(point["time_from_start"], place + ", time_from_start"));
      const std::size_t joints = row.size() - (timed ? 1 : 0);
      derivatives_.velocities.push_back(derivatives(point, "velocities", joints, number));
      derivatives_.accelerations.push_back(derivatives(point, "accelerations", joints, number));
      append(out, std::move(row), name_, place);
    }
    out.notes = std::move(notes_);
    return out;
  }

  /// Of a point that has as many of them as joints, all of which are numbers; else none.
  std::vector<double> derivatives(const Json& point, const char* key, std::size_t joints,
                                  std::size_t number) {
    if (!point.contains(key) || point[key].is_null() || point[key].empty()) return {};
    const Json& given = point[key];
    const auto is_finite = [](const Json& x) {
      return x.is_number() && std::isfinite(x.get<double>());
    };
    if (given.is_array() && given.size() == joints && std::ranges::all_of(given, is_finite))
      return given.get<std::vector<double>>();
    if (derivatives_.unfit.empty())
      derivatives_.unfit = "point " + std::to_string(number) + ", " + key;
    return {};
  }

  /// A duration of ROS, or seconds.
  double seconds(const Json& value, const std::string& at) const {
    if (value.is_number()) return value.get<double>();
    if (value.is_object())
      for (const auto& [whole, nano] : {std::pair("sec", "nanosec"), std::pair("secs", "nsecs")})
        if (value.contains(whole) && value[whole].is_number()) {
          const bool has_part = value.contains(nano);
          if (has_part && !value[nano].is_number()) break;
          return value[whole].get<double>() + (has_part ? 1e-9 * value[nano].get<double>() : 0);
        }
    refuse(at, "a number of seconds, or \"sec\" and \"nanosec\", are expected");
  }

  /// A JointState of which positions are rows, as cuRobo's plans.
  NamedPath read_positions(const Json& value, const char* key, const std::string& at) const {
    NamedPath out;
    const std::string place = member(at, key);
    for (const char* label : {"joint_names", "name"})
      if (out.joints.empty() && value.contains(label) && value[label].is_array()) {
        out.joints_at = member(at, label);
        out.joints = names(value[label], out.joints_at);
      }
    const Json* rows = &value[key];
    const auto is_list_of_lists = [](const Json& x) {
      return x.is_array() && !x.empty() && x.front().is_array();
    };
    if (is_list_of_lists(*rows) && is_list_of_lists(rows->front())) {
      if (rows->size() > 1)
        refuse(place,
               std::to_string(rows->size()) + " trajectories; put each into a file of its own");
      rows = &rows->front();
    }
    if (rows->is_array() && !rows->empty() && rows->front().is_number())
      append(out, numbers(*rows, place), name_, place);
    else
      add_rows(*rows, place, out);
    add_steps(value, at, out);
    return out;
  }

  /// Times of rows that are equally long apart.
  void add_steps(const Json& value, const std::string& at, NamedPath& out) const {
    for (const char* key : {"interpolation_dt", "dt"}) {
      if (!value.contains(key) || value[key].is_null()) continue;
      const Json* step = &value[key];
      while (step->is_array() && step->size() == 1) step = &step->front();
      if (!step->is_number() || !(step->get<double>() > 0) || out.joints.empty())
        refuse(member(at, key), out.joints.empty()
                                    ? "a time, but no \"joint_names\" to tell columns apart by"
                                    : "a number of seconds above 0 is expected");
      out.joints.emplace_back("time_from_start");
      for (std::size_t i = 0; i < out.waypoints.size(); ++i)
        out.waypoints[i].push_back(static_cast<double>(i) * step->get<double>());
      return;
    }
  }

  const std::string& name_;
  PathDerivatives& derivatives_;
  std::vector<std::string> notes_;
};

}  // namespace

NamedPath parse_path_json(std::string_view text, const std::string& name,
                          PathDerivatives& derivatives) {
  derivatives = {};
  return TrajectoryReader(name, derivatives)
      .read(read_json<Json>(text, name, "mend the path there"), "");
}

NamedPath parse_path_json(std::string_view text, const std::string& name) {
  PathDerivatives derivatives;
  return parse_path_json(text, name, derivatives);
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

std::vector<double> times_of(const NamedPath& path, const Robot& robot) {
  const std::vector<std::size_t> columns = time_columns(path, robot);
  if (columns.empty()) return {};
  std::vector<double> out;
  for (const std::vector<double>& row : path.waypoints) out.push_back(row[columns.front()]);
  if (!(out.back() > out.front())) out.clear();
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
    const auto refuse = [&](const std::string& what) {
      fail(name, path.joints_at.empty() ? what : path.joints_at + ": " + what);
    };
    for (std::size_t j = 0; j < path.joints.size(); ++j) {
      const std::string& joint = path.joints[j];
      if (std::find(times.begin(), times.end(), j) != times.end()) continue;
      if (std::count(path.joints.begin(), path.joints.end(), joint) > 1)
        refuse("joint '" + joint + "' is named twice");
      if (!has_variable(robot, joint)) refuse(none(joint));
    }
    require_times_in_order(path, times, name);
    for (std::size_t i = 0; i < count; ++i) {
      const std::string& joint = robot.variables[i].name;
      if (fixed.contains(joint)) continue;
      const auto it = std::find(path.joints.begin(), path.joints.end(), joint);
      if (it == path.joints.end())
        refuse(std::string("no column for joint '")
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
