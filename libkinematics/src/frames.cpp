// Frames of tools, links and objects, and how they move with the unknowns of a constraint problem.
#include "frames.h"

#include <span>

namespace kaboum::kinematics {
namespace {

using Kind = FrameId::Kind;

void add_columns(const Frame* frame, const Cost::Derivative& by_twist, Eigen::Index row,
                 Costs::Derivative& out) {
  if (frame == nullptr || frame->count == 0) return;
  for (Eigen::Index i = 0; i < by_twist.rows(); ++i) {
    if (frame->rigid) {
      out.block<1, 6>(row + i, frame->first) += by_twist.row(i);
      continue;
    }
    for (Eigen::Index k = 0; k < frame->count; ++k)
      out(row + i, frame->first + k) += by_twist.row(i).dot(frame->twists.col(k));
  }
}

Cost cost_at(const Constraint& c, const Frames& frames, double length) {
  const Transform world;
  const Frame *a = frames.find(c.first.frame), *b = frames.find(c.second.frame);
  return cost(c, a != nullptr ? a->pose : world, b != nullptr ? b->pose : world, length);
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
  jacobian(robot.arm, robot.base, q, tools[index].twists, tools[index].pose);
  for (std::size_t k = 0; k < robot.links.size(); ++k)
    jacobian(arm_to(robot.arm, robot.links[k]), robot.base, std::span(q).first(robot.links[k].axes),
             links[index][k].twists, links[index][k].pose);
}

void Frames::place_poses(const PlacedArm& robot, std::size_t index, const std::vector<double>& q) {
  tools[index].pose = robot.base * forward(robot.arm, q);
  for (std::size_t k = 0; k < robot.links.size(); ++k)
    links[index][k].pose = robot.base * forward(arm_to(robot.arm, robot.links[k]),
                                                std::span(q).first(robot.links[k].axes));
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
  // As many rows as the last time: memory is used again.
  out.derivative.setZero(out.value.size(), frames.unknowns);
  Eigen::Index row = 0;
  for (const Constraint& c : constraints) {
    const Cost cost = cost_at(c, frames, length);
    if (row + cost.value.size() > out.value.size()) {
      out.value.conservativeResize(row + cost.value.size());
      out.derivative.conservativeResizeLike(
          Costs::Derivative::Zero(out.value.size(), frames.unknowns));
    }
    out.value.segment(row, cost.value.size()) = cost.value;
    add_columns(frames.find(c.first.frame), cost.first, row, out.derivative);
    add_columns(frames.find(c.second.frame), cost.second, row, out.derivative);
    row += cost.value.size();
  }
  out.value.conservativeResize(row);
  out.derivative.conservativeResize(row, Eigen::NoChange);
}

double largest_cost(const std::vector<Constraint>& constraints, const Frames& frames,
                    double length) {
  double most = 0;
  for (const Constraint& c : constraints)
    for (const double v : cost_at(c, frames, length).value) most = larger(most, std::abs(v));
  return most;
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
