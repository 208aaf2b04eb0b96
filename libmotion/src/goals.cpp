// Goals of motions: configurations at which a tool has a pose, or that meet constraints.

#include <kaboum/kinematics/inverse.h>
#include <kaboum/kinematics/sample.h>
#include <kaboum/motion/goals.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/checker.h>

#include <algorithm>

namespace kaboum::motion {
namespace {

using geom::Transform;

/// In a frame that has this pose in the feature's.
kinematics::Feature seen_from(const kinematics::Feature& feature, const Transform& frame) {
  const Transform to = kinematics::inverse(frame);
  if (const auto* point = std::get_if<kinematics::Point>(&feature))
    return kinematics::Point{to * point->position};
  if (const auto* line = std::get_if<kinematics::Line>(&feature))
    return kinematics::Line{to * line->position, (to.linear * line->direction).normalized()};
  if (const auto* plane = std::get_if<kinematics::Plane>(&feature))
    return kinematics::Plane{to * plane->position, (to.linear * plane->normal).normalized()};
  auto surface = std::get<kinematics::Surface>(feature);
  surface.position = to * surface.position;
  surface.normal = (to.linear * surface.normal).normalized();
  for (geom::Vec3& corner : surface.outline) corner = to * corner;
  return surface;
}

}  // namespace

Goals pose_goals(const world::RobotModel& robot, const world::ToolFrame& tool,
                 const geom::Transform& pose, const std::vector<double>& start, std::uint64_t seed,
                 const std::function<void(const std::string&)>& progress) {
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
  Goals out;
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

Goals constraint_goals(const world::RobotModel& robot, const world::ToolFrame& tool,
                       std::span<const PathConstraint> constraints,
                       const std::vector<double>& start, std::uint64_t seed, std::size_t most) {
  using Kind = kinematics::FrameId::Kind;
  const robot::Robot& chain = robot.kinematics;
  const std::string& root = chain.links.front().name;
  kinematics::PlacedArm placed{kinematics::arm_of(chain, root, chain.links[tool.link].name),
                               robot.base};
  const kinematics::Arm arm = placed.arm;
  placed.arm.tool = placed.arm.tool * tool.pose;
  kinematics::ConstraintProblem problem;
  for (const PathConstraint& c : constraints) {
    // Features of the tool leave the closed form to the sampler.
    kinematics::PlacedFeature moving{{Kind::Tool, 0}, seen_from(c.moving, tool.pose)};
    if (c.link != tool.link) {
      placed.links.push_back(kinematics::frame_of(chain, arm, root, chain.links[c.link].name));
      moving = {{Kind::Link, 0, placed.links.size() - 1}, c.moving};
    }
    problem.constraints.push_back({c.relation, moving, {{Kind::World}, c.resting}, c.value});
  }
  problem.robots.push_back(std::move(placed));
  kinematics::SampleOptions options;
  options.seed = seed;
  kinematics::ConstraintSampler sampler(std::move(problem), options);
  Goals out;
  out.why = "they are drawn at random";
  for (std::size_t i = 0; i < most; ++i) {
    const std::optional<kinematics::Sample> sample = sampler.next();
    if (!sample) break;
    std::vector<double> q = start;
    const std::vector<double>& joints = sample->at.joints.front();
    for (std::size_t k = 0; k < joints.size(); ++k) q[arm.variables[k]] = joints[k];
    if (find_out_of_limits(chain, q)) continue;
    if (check_constraints(robot, {q}, constraints).outcome == ConstraintAnswer::Outcome::Kept &&
        std::ranges::find(out.configurations, q) == out.configurations.end())
      out.configurations.push_back(std::move(q));
  }
  return out;
}

Goals preferred_goals(const world::World& world, std::size_t robot, const world::ToolFrame& tool,
                      const world::ConstraintSet& set, const std::vector<double>& start,
                      std::uint64_t seed) {
  const world::Checker checker(world);
  world::Scratch scratch;
  world::WorldState state = initial_state(world);
  const auto is_free = [&](const std::vector<double>& q) {
    state.q[robot] = q;
    return checker.is_free(state, scratch);
  };
  Goals out;
  for (std::size_t count = set.preferred.size() + 1; count > 0; --count) {
    out = constraint_goals(world.robots.at(robot), tool,
                           path_constraints(world, initial_state(world), robot, set, count - 1),
                           start, seed);
    if (std::ranges::any_of(out.configurations, is_free)) break;
  }
  return out;
}

}  // namespace kaboum::motion
