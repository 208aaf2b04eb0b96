// Goals of motions as poses of a tool.

#include <kaboum/kinematics/inverse.h>
#include <kaboum/motion/pose_goals.h>

namespace kaboum::motion {

PoseGoals pose_goals(const world::RobotModel& robot, const world::ToolFrame& tool,
                     const geom::Transform& pose, const std::vector<double>& start,
                     std::uint64_t seed, const std::function<void(const std::string&)>& progress) {
  const robot::Robot& chain = robot.kinematics;
  kinematics::Arm arm =
      kinematics::arm_of(chain, chain.links.front().name, chain.links[tool.link].name);
  arm.tool = arm.tool * tool.pose;
  kinematics::InverseRequest request;
  request.target = kinematics::inverse(robot.base) * pose;
  for (const std::uint32_t v : arm.variables) request.reference.push_back(start[v]);
  request.copies = true;
  request.seed = seed;
  request.progress = progress;
  const kinematics::InverseAnswer answer = find_configurations(arm, request);
  PoseGoals out;
  for (const kinematics::InverseAnswer::Row& row : answer.rows) {
    if (!row.within) continue;
    std::vector<double> q = start;
    for (std::size_t i = 0; i < row.q.size(); ++i) q[arm.variables[i]] = row.q[i];
    out.configurations.push_back(std::move(q));
  }
  out.why = !answer.form               ? "the search for them is numeric"
            : !answer.families.empty() ? "some of each family with a free joint are tried"
                                       : answer.incomplete;
  out.complete = out.why.empty();
  return out;
}

}  // namespace kaboum::motion
