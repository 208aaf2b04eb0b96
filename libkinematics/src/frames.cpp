// Frames of tools, links and objects, and how they move with the unknowns of a constraint problem.
#include "frames.h"

#include <span>

namespace kaboum::kinematics {
namespace {

using Kind = FrameId::Kind;

void add_columns(const Frame* frame, const Cost::Derivative& by_twist, Eigen::Index row,
                 Eigen::MatrixXd& out) {
  if (frame == nullptr || frame->count == 0) return;
  auto block = out.block(row, frame->first, by_twist.rows(), frame->count);
  if (frame->rigid)
    block += by_twist;
  else
    block.noalias() += by_twist * frame->twists;
}

/// Pose and derivative, in the world, of the tool of an arm.
void place_end(const Arm& arm, const Transform& base, std::span<const double> q, Frame& frame) {
  Transform pose;
  frame.twists = jacobian(arm, q, &pose);
  frame.twists.topRows<3>() = base.linear * frame.twists.topRows<3>();
  frame.twists.bottomRows<3>() = base.linear * frame.twists.bottomRows<3>();
  frame.pose = base * pose;
}

/// Fixed to another frame, in which its own has this pose.
Feature placed(Feature feature, const Transform& pose) {
  const auto turn = [&](Vec3& direction) { direction = (pose.linear * direction).normalized(); };
  std::visit([&](auto& f) { f.position = pose * f.position; }, feature);
  if (auto* line = std::get_if<Line>(&feature)) turn(line->direction);
  if (auto* plane = std::get_if<Plane>(&feature)) turn(plane->normal);
  if (auto* surface = std::get_if<Surface>(&feature)) {
    turn(surface->normal);
    for (Vec3& p : surface->outline) p = pose * p;
  }
  return feature;
}

PlacedFeature without_end_link(const ConstraintProblem& problem, const PlacedFeature& f) {
  if (f.frame.kind != Kind::Link) return f;
  const PlacedArm& robot = problem.robots[f.frame.index];
  const ArmFrame& link = robot.links[f.frame.link];
  if (link.axes == 0) return {{}, placed(f.feature, robot.base * link.pose)};
  if (link.axes < robot.arm.axes.size()) return f;
  return {{Kind::Tool, f.frame.index}, placed(f.feature, inverse(robot.arm.tool) * link.pose)};
}

}  // namespace

void Frames::add_robot(const PlacedArm& robot, bool rigid) {
  Frame tool;
  tool.first = unknowns;
  tool.rigid = rigid;
  tool.count = rigid ? 6 : static_cast<Eigen::Index>(robot.arm.axes.size());
  std::vector<Frame>& of_robot = links.emplace_back();
  if (!rigid)
    for (const ArmFrame& link : robot.links) {
      Frame& frame = of_robot.emplace_back();
      frame.first = unknowns;
      frame.rigid = false;
      frame.count = static_cast<Eigen::Index>(link.axes);
    }
  unknowns += tool.count;
  tools.push_back(std::move(tool));
}

void Frames::add_object() {
  Frame frame;
  frame.first = unknowns;
  frame.count = 6;
  unknowns += 6;
  objects.push_back(std::move(frame));
}

void Frames::place(const PlacedArm& robot, std::size_t index, const std::vector<double>& q) {
  place_end(robot.arm, robot.base, q, tools[index]);
  for (std::size_t k = 0; k < robot.links.size(); ++k)
    place_end(arm_to(robot.arm, robot.links[k]), robot.base,
              std::span(q).first(robot.links[k].axes), links[index][k]);
}

const Frame* Frames::find(const FrameId& id) const {
  switch (id.kind) {
    case Kind::Tool:
      return &tools[id.index];
    case Kind::Object:
      return &objects[id.index];
    case Kind::Link:
      return &links[id.index][id.link];
    default:
      return nullptr;
  }
}

void assemble(const std::vector<Constraint>& constraints, const Frames& frames, double length,
              Costs& out) {
  const Transform world;
  out.value.resize(static_cast<Eigen::Index>(4 * constraints.size()));
  out.derivative.setZero(out.value.size(), frames.unknowns);
  Eigen::Index row = 0;
  for (const Constraint& c : constraints) {
    const Frame *a = frames.find(c.first.frame), *b = frames.find(c.second.frame);
    const Cost cost =
        kinematics::cost(c, a != nullptr ? a->pose : world, b != nullptr ? b->pose : world, length);
    out.value.segment(row, cost.value.size()) = cost.value;
    add_columns(a, cost.first, row, out.derivative);
    add_columns(b, cost.second, row, out.derivative);
    row += cost.value.size();
  }
  out.value.conservativeResize(row);
  out.derivative.conservativeResize(row, Eigen::NoChange);
}

std::vector<Constraint> without_end_links(const ConstraintProblem& problem) {
  std::vector<Constraint> out = problem.constraints;
  for (Constraint& c : out) {
    c.first = without_end_link(problem, c.first);
    c.second = without_end_link(problem, c.second);
  }
  return out;
}

}  // namespace kaboum::kinematics
