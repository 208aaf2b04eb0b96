// Motions of a plan's nodes, with the blends of their corners that are certified.

#include "node_motions.h"

#include <kaboum/manipulation/kept_constraints.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/motion/sampled_path.h>
#include <kaboum/robot/kinematics.h>

#include <utility>

namespace kaboum::execution {
namespace {

using world::Transform;

/// As motions of plans are decided.
constexpr double kResolution = 1e-5;

/// @param held  how objects are held, by words: where fingers are
world::WorldState world_state(const judge::CellState& state,
                              const std::vector<std::optional<world::Attachment>>& held) {
  world::WorldState out;
  out.q = state.q;
  for (const judge::CellState::Place& place : state.objects) {
    out.poses.push_back(place.pose);
    out.attachments.emplace_back();
    const std::size_t o = out.attachments.size() - 1;
    if (const auto& hold = place.hold)
      out.attachments.back() = {hold->robot, hold->link, hold->pose, hold->touching,
                                hold->link_touches};
    if (out.attachments.back() && o < held.size() && held[o])
      out.attachments.back()->fingers = held[o]->fingers;
    out.absent.push_back(place.away);
  }
  return out;
}

Transform pose_of_link(const world::World& world, const world::WorldState& state, std::size_t robot,
                       std::uint32_t link) {
  const world::RobotModel& model = world.robots[robot];
  return model.base * robot::forward(model.kinematics, state.q[robot])[link];
}

/// Takes and lets go what a motion holds, at the poses that words have.
void hold(const world::World& world, world::WorldState& state, const MotionPart& part) {
  for (std::size_t o = 0; o < state.attachments.size(); ++o) {
    auto& held = state.attachments[o];
    const auto wanted = part.holds.find(o);
    const bool own = held && held->robot == part.robot;
    if (own && wanted != part.holds.end() && wanted->second == held->link) continue;
    if (!own && wanted == part.holds.end()) continue;
    const Transform pose =
        held ? pose_of_link(world, state, held->robot, held->link) * held->pose : state.poses[o];
    if (wanted == part.holds.end()) {
      held.reset();
      state.poses[o] = manipulation::place_of(manipulation::word_of(pose), world, o).pose;
      continue;
    }
    const world::Attachment now = hold_of(
        part, world, o, inverse(pose_of_link(world, state, part.robot, wanted->second)) * pose);
    // Rounded as the word has it.
    held = now;
    held->pose = manipulation::place_of(manipulation::word_of(now.pose), world, o).pose;
  }
}

/// Motions that follow each other without a change of what is held, as one.
std::vector<MotionPart> joined(std::vector<MotionPart> parts) {
  std::vector<MotionPart> out;
  for (MotionPart& part : parts) {
    if (!out.empty() && out.back().robot == part.robot && out.back().holds == part.holds &&
        !out.back().moves_fingers() && !part.moves_fingers() && !out.back().path.empty() &&
        !part.path.empty() && out.back().path.back() == part.path.front())
      out.back().path.insert(out.back().path.end(), part.path.begin() + 1, part.path.end());
    else
      out.push_back(std::move(part));
  }
  return out;
}

}  // namespace

NodeMotions::NodeMotions(const world::World& world, const plan::Model& model,
                         const plan::Plan& plan, SimulationOptions options)
    : world_(world), model_(model), plan_(plan), options_(std::move(options)) {
  require_valid(options_, world);
  if (options_.motion.blend > 0) checker_.emplace(world);
}

const std::vector<MotionPart>& NodeMotions::of(plan::Index node, const StatedState& before) {
  const auto [found, added] = known_.try_emplace({node, before.words});
  if (!added) return found->second;
  const plan::Plan::Node& n = plan_.nodes[node];
  if (!n.acts) return found->second;
  const std::string where = "node " + std::to_string(node) + ", " + action_text(model_, n.action);
  world::WorldState state = world_state(before.state, before.held);
  try {
    for (const plan::Plan::Call& call : n.calls) {
      std::vector<MotionPart> parts = parts_of(call.payload, world_, where);
      if (options_.motion.blend > 0) {
        parts = joined(std::move(parts));
        blend(parts, state, call);
      }
      for (MotionPart& part : parts) found->second.push_back(std::move(part));
    }
  } catch (...) {
    known_.erase(found);
    throw;
  }
  return found->second;
}

void NodeMotions::blend(std::vector<MotionPart>& parts, world::WorldState& state,
                        const plan::Plan::Call& call) const {
  for (MotionPart& part : parts) {
    if (part.path.empty() || part.path.front() != state.q[part.robot]) return;  // is told of later
    hold(world_, state, part);
    blend(part, state, call);
    state.q[part.robot] = part.path.back();
  }
}

void NodeMotions::blend(MotionPart& part, const world::WorldState& state,
                        const plan::Plan::Call& call) const {
  const std::string& function = model_.externals[call.external].name;
  const auto kept = manipulation::kept_constraints(world_, state, part.robot, part.path, function,
                                                   call.arguments);
  const std::vector<double> asked(part.path.size(), kept ? options_.motion.blend : 0);
  part.blends = motion::certified_blends(
      {*checker_, state, part.robot, kept ? *kept : std::vector<motion::PathConstraint>(),
       finger_room_of(part, world_)},
      part.path, limits_of(options_, world_, part.robot), asked, options_.motion.rate, kResolution);
}

}  // namespace kaboum::execution
