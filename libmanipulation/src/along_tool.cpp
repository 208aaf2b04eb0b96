// Paths that leave and arrive along the tool: two short lines that inverse kinematics follows, and
// a path between them (docs/planning/geometry.md).
#include "along_tool.h"

#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>

#include "lines.h"

namespace kaboum::manipulation {
namespace {

/// How far the tool backs off, the farthest first. [m]
constexpr std::array<double, 2> kDepths{0.1, 0.04};

class AlongTool {
 public:
  AlongTool(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
            const motion::PathOptions& options)
      : checker_(checker),
        state_(state),
        robot_(robot),
        model_(checker.world().robots[robot]),
        options_(options) {}

  motion::PathAnswer find(const std::vector<double>& start,
                          const std::vector<std::vector<double>>& goals) {
    std::vector<robot::Path> lines;  // from a goal back
    std::vector<std::vector<double>> places;
    for (const std::vector<double>& goal : goals) {
      lines.push_back(back_off(goal));
      places.push_back(lines.back().back());
    }
    motion::PathOptions straight = options_;
    straight.most_work = std::min(kNoWork, options_.most_work);
    motion::PathAnswer answer = look({start}, lines, places, straight);
    if (answer.outcome == motion::PathAnswer::Outcome::Found) return answer;
    return look(back_off(start), lines, places, options_);
  }

 private:
  /// Straight against the tool's direction; the configuration alone where there is no room for it.
  [[nodiscard]] robot::Path back_off(const std::vector<double>& q) {
    if (q == model_.home || model_.tools.empty()) return {q};
    const world::ToolFrame& tool = model_.tools.front();
    const world::Transform link = model_.base * robot::forward(model_.kinematics, q)[tool.link];
    for (const double depth : kDepths) {
      world::Transform to = link;
      to.translation -= depth * (link.linear * tool.pose.linear.col(2));
      auto line = follow_line(model_, tool.link, q, to, 0.5 * depth);
      if (!line) continue;
      spent_.motions += line->size() - 1;
      if (check_motion(checker_, state_, robot_, *line, options_.check).outcome ==
          world::MotionAnswer::Outcome::Free)
        return *line;
    }
    return {q};
  }

  /// From the end of the first line to that of one of the others.
  motion::PathAnswer look(const robot::Path& first, const std::vector<robot::Path>& lines,
                          const std::vector<std::vector<double>>& places,
                          const motion::PathOptions& options) {
    motion::PathAnswer answer = find_path(checker_, state_, robot_, first.back(), places, options);
    spent_.configurations += answer.spent.configurations;
    spent_.motions += answer.spent.motions;
    answer.spent = spent_;
    if (answer.outcome != motion::PathAnswer::Outcome::Found) return answer;
    robot::Path path(first.begin(), first.end() - 1);
    path.insert(path.end(), answer.path.begin(), answer.path.end());
    const robot::Path& last = lines[answer.goal];
    path.insert(path.end(), last.rbegin() + 1, last.rend());
    answer.path = std::move(path);
    return answer;
  }

  const world::Checker& checker_;
  const world::WorldState& state_;
  std::size_t robot_;
  const world::RobotModel& model_;
  const motion::PathOptions& options_;
  motion::Spent spent_;
};

}  // namespace

motion::PathAnswer find_path_along_tool(const world::Checker& checker,
                                        const world::WorldState& state, std::size_t robot,
                                        const std::vector<double>& start,
                                        const std::vector<std::vector<double>>& goals,
                                        const motion::PathOptions& options) {
  return AlongTool(checker, state, robot, options).find(start, goals);
}

}  // namespace kaboum::manipulation
