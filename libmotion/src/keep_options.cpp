// Constraints of motions by the names that users give them.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/kinematics/inverse.h>
#include <kaboum/motion/keep_options.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/features.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace kaboum::motion {
namespace {

using geom::Transform;
using geom::Vec3;
using kinematics::Line;
using kinematics::Plane;
using kinematics::Point;

/// So many tolerances apart, start and goal of a line tell its direction.
constexpr double kLeastWay = 10;
constexpr double kUsualAngle = 0.05, kUsualLength = 0.002;

[[noreturn]] void refuse_keep(const std::string& what) {
  throw Error(ErrorCode::InvalidArgument, "«keep»: " + what);
}

/// Makes the constraints of the usual names.
class UsualConstraints {
 public:
  UsualConstraints(const world::RobotModel& robot, const world::ToolFrame& tool,
                   const std::vector<double>& start, std::span<const std::vector<double>> goals)
      : robot_(robot), tool_(tool), goals_(goals), at_start_(place(start)) {}

  std::vector<PathConstraint> make(const std::string& name, double within) const {
    if (name == "upright") return {direction(name, Vec3::UnitZ(), within)};
    if (name == "orientation")
      return {direction(name, at_start_.linear.col(0), within),
              direction(name, at_start_.linear.col(2), within)};
    PathConstraint out;
    out.name = name;
    out.link = tool_.link;
    out.moving = Point{tool_.pose.translation};
    out.within = within;
    if (name == "level")
      out.resting = Plane{at_start_.translation, Vec3::UnitZ()};
    else
      out.resting = line(within);
    return {out};
  }

 private:
  [[nodiscard]] Transform place(const std::vector<double>& q) const {
    return robot_.base * robot::forward(robot_.kinematics, q)[tool_.link] * tool_.pose;
  }

  /// A direction of the world in which something of the tool points at the start.
  [[nodiscard]] PathConstraint direction(const std::string& name, const Vec3& d,
                                         double within) const {
    PathConstraint out;
    out.name = name;
    out.relation = kinematics::Relation::Parallel;
    out.link = tool_.link;
    const Vec3 of_tool = at_start_.linear.transpose() * d;
    out.moving = Line{tool_.pose.translation, (tool_.pose.linear * of_tool).normalized()};
    out.resting = Line{at_start_.translation, d.normalized()};
    out.within_angle = within;
    return out;
  }

  [[nodiscard]] kinematics::Feature line(double within) const {
    const Vec3 begin = at_start_.translation;
    std::optional<Vec3> end;
    for (const std::vector<double>& goal : goals_) {
      const Vec3 there = place(goal).translation;
      if (end && (there - *end).norm() > 0.5 * within)
        refuse_keep("'line' leads to one place, but the tool is in different places at the goals");
      if (!end) end = there;
    }
    const Vec3 way = end.value_or(begin) - begin;
    if (way.norm() <= 1e-9 * within) return Point{begin};
    if (way.norm() < kLeastWay * within)
      refuse_keep("'line': the tool goes " + number_text(way.norm()) + ", less than " +
                  number_text(kLeastWay) +
                  " tolerances, which gives no direction; state a smaller tolerance: line=" +
                  number_text(way.norm() / (2 * kLeastWay)));
    return Line{begin, way.normalized()};
  }

  const world::RobotModel& robot_;
  const world::ToolFrame& tool_;
  std::span<const std::vector<double>> goals_;
  Transform at_start_;
};

/// Names that are stated together: "upright,line=0.001".
std::vector<std::string> split(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const std::string& text : texts) {
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');)
      if (!part.empty()) out.push_back(part);
  }
  return out;
}

/// An angle, or a length in the unit.
double tolerance_of(const std::string& name, const std::string& text, bool angle,
                    const std::string& unit) {
  const std::optional<Length> given = parse_length(text);
  if (!given || given->percent || (angle && given->unit != Length::Unit::Own))
    refuse_keep(
        "'" + name + "=" + text + "': a tolerance of '" + name + "' is " +
        (angle ? "an angle above 0, in radians, without a unit"
               : "a length above 0, in the scene's unit or with one, as in 1mm") +
        (given && given->percent ? " (there is nothing that it could be a percentage of)" : ""));
  return given->in(unit).value;
}

std::vector<Option<KeepRequest>> keep_table() {
  return {
      option<KeepRequest>(
          {.name = "keep",
           .text =
               "What the motion keeps at every instant, certified: upright (what of the tool "
               "points up at the start goes on doing so), orientation (the tool does not "
               "turn), line (the tool's origin stays on the straight line through start and goal), "
               "level (it stays at its height), each perhaps with a tolerance (upright=0.1 [0.05 "
               "rad], "
               "line=0.001 or line=1mm [0.002, in the scene's unit]); or constraints of the scene "
               "by their "
               "name",
           .values = "NAME[=TOLERANCE],…",
           .kind = OptionDescription::Kind::Names},
          [](auto& r) -> auto& { return r.keep; }),
      option<KeepRequest>(
          {.name = "tool",
           .text = "Tool or link of the robot that is meant: its origin and its axes",
           .values = "NAME",
           .otherwise = "the only one; of a robot without tools its last link"},
          [](auto& r) -> auto& { return r.tool; })};
}

}  // namespace

const std::vector<Option<KeepRequest>>& keep_options() {
  static const std::vector<Option<KeepRequest>> options = keep_table();
  return options;
}

world::ToolFrame moving_frame(const world::RobotModel& robot, const std::string& name) {
  const robot::Robot& kinematics = robot.kinematics;
  std::vector<std::string> names;
  for (const world::ToolFrame& tool : robot.tools) {
    if (tool.name == name || (name.empty() && robot.tools.size() == 1)) return tool;
    names.push_back(tool.name);
  }
  for (std::uint32_t i = 0; i < kinematics.links.size(); ++i) {
    if (kinematics.links[i].name == name) return {name, i, {}};
    names.push_back(kinematics.links[i].name);
  }
  if (!name.empty())
    throw Error(ErrorCode::InvalidArgument, "«tool»: robot '" + robot.name +
                                                "' has no tool or link '" + name + "'" +
                                                did_you_mean(name, names));
  if (!robot.tools.empty()) return world::tool_named(robot, name);
  try {
    const std::string tip = kinematics::only_tip(kinematics);
    return {tip, *kinematics.find_link(tip), {}};
  } catch (const Error&) {
    throw Error(ErrorCode::InvalidArgument,
                "«tool»: robot '" + robot.name +
                    "' has no tools and several last links: name the link that is meant, or state "
                    "tools in the scene");
  }
}

std::vector<PathConstraint> constraints_of(const world::World& world,
                                           const world::WorldState& state, std::size_t robot,
                                           const std::vector<double>& start,
                                           std::span<const std::vector<double>> goals,
                                           const KeepRequest& request) {
  std::vector<PathConstraint> out = carried_constraints(world, state, robot);
  const world::RobotModel& model = world.robots.at(robot);
  if (!request.tool.empty()) static_cast<void>(moving_frame(model, request.tool));
  for (const std::string& text : split(request.keep)) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::vector<PathConstraint> more;
    if (world::is_usual_constraint(name)) {
      const bool angle = name == "upright" || name == "orientation";
      const double within = equals != std::string::npos
                                ? tolerance_of(name, text.substr(equals + 1), angle, world.unit)
                                : (angle ? kUsualAngle : kUsualLength);
      const world::ToolFrame tool = moving_frame(model, request.tool);
      more = UsualConstraints(model, tool, start, goals).make(name, within);
    } else {
      std::vector<std::string> names(world::kUsualConstraints.begin(),
                                     world::kUsualConstraints.end());
      bool known = false;
      for (const world::ConstraintSet& set : world.constraints) {
        names.push_back(set.name);
        known = known || set.name == name;
      }
      if (!known) {
        const std::string similar = did_you_mean(name, names);
        refuse_keep("the scene has no constraints '" + name + "'" +
                    (similar.empty() ? "; without, there are upright, orientation, line and level"
                                     : similar));
      }
      if (equals != std::string::npos)
        refuse_keep("'" + text + "': the scene states the tolerances of its constraints");
      more = path_constraints(world, state, robot, world.constraint_set(name));
    }
    out.insert(out.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
  }
  return out;
}

std::string words_of(std::span<const PathConstraint> constraints,
                     std::span<const double> deviations) {
  std::string out;
  for (std::size_t i = 0; i < constraints.size();) {
    const std::string& name = constraints[i].name;
    std::vector<std::string> within;
    double deviation = 0;
    const auto add = [&](double tolerance, const char* unit) {
      const std::string text = number_text(tolerance) + unit;
      if (std::ranges::find(within, text) == within.end()) within.push_back(text);
    };
    for (; i < constraints.size() && constraints[i].name == name; ++i) {
      const PathConstraint& c = constraints[i];
      const kinematics::Measures measures = measures_of(kinematics_constraint(c));
      if (measures.length) add(c.within, "");
      if (measures.angle) add(c.within_angle, " rad");
      if (i < deviations.size()) deviation = std::max(deviation, deviations[i]);
    }
    out += (out.empty() ? "" : "; ") + name + " within ";
    for (std::size_t k = 0; k < within.size(); ++k) out += (k == 0 ? "" : " and ") + within[k];
    if (!deviations.empty())
      out += " (" + std::to_string(std::lround(100 * deviation)) + " % of it seen)";
  }
  return out;
}

}  // namespace kaboum::motion
