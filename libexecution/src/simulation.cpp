// A plan's motions, sample by sample, among exact meshes.

#include <kaboum/base/error.h>
#include <kaboum/execution/simulation.h>

#include <algorithm>
#include <cmath>

#include "node_motions.h"
#include "simulation_state.h"

namespace kaboum::execution {
namespace {

constexpr std::size_t kMostProblems = 20;
/// Between what is mounted and its seat, beside both ε. [length]
constexpr double kMostGap = 2e-3;
/// Of differences of samples, as shares of a limit: what rounding of doubles may add at 1 kHz.
constexpr double kRounding = 1e-6;

}  // namespace

SimulationReport& SimulationReport::operator+=(const SimulationReport& other) {
  steps += other.steps;
  motions += other.motions;
  samples += other.samples;
  collisions += other.collisions;
  limit_violations += other.limit_violations;
  executed.motions += other.executed.motions;
  executed.samples += other.executed.samples;
  executed.collisions += other.executed.collisions;
  executed.longest_gap = std::max(executed.longest_gap, other.executed.longest_gap);
  executed.most_strayed = std::max(executed.most_strayed, other.executed.most_strayed);
  executed.margin = std::max(executed.margin, other.executed.margin);
  jumps += other.jumps;
  seconds += other.seconds;
  most_velocity = std::max(most_velocity, other.most_velocity);
  most_acceleration = std::max(most_acceleration, other.most_acceleration);
  most_jerk = std::max(most_jerk, other.most_jerk);
  blends += other.blends;
  for (const std::string& problem : other.problems)
    if (problems.size() < kMostProblems) problems.push_back(problem);
  return *this;
}

Simulation::Simulation(const world::World& world, const judge::Cell& cell, const plan::Model& model,
                       const plan::Plan& plan, SimulationOptions options, MotionSink sink,
                       std::shared_ptr<NodeMotions> motions)
    : world_(world),
      cell_(cell),
      model_(model),
      plan_(plan),
      options_(std::move(options)),
      sink_(std::move(sink)),
      motions_(std::move(motions)) {
  require_valid(options_, world_);
  if (!motions_) motions_ = std::make_shared<NodeMotions>(world_, model_, plan_, options_);
  for (const plan::Plan::Node& node : plan.nodes)
    for (const plan::Plan::Call& call : node.calls)
      if (model.externals[call.external].name == "mate" && call.arguments.size() == 5)
        mates_[call.arguments[1]].insert(call.arguments[3]);
}

void Simulation::say(const std::string& problem) {
  if (report_.problems.size() < kMostProblems) report_.problems.push_back(where_ + ": " + problem);
}

void Simulation::carry_out(const plan::RunStep& step, const std::vector<ExecutedMotion>& executed) {
  look_at_node(step, executed, true);
}

void Simulation::begin(const plan::RunStep& step, const std::vector<ExecutedMotion>& executed) {
  look_at_node(step, executed, false);
}

/// @param is_done  else the last of the executed motions has not come to its end
void Simulation::look_at_node(const plan::RunStep& step,
                              const std::vector<ExecutedMotion>& executed, bool is_done) {
  const plan::Plan::Node& node = plan_.nodes[step.node];
  const auto before = state_of(world_, model_, step.before);
  const auto after = state_of(world_, model_, step.after);
  if (!before || !after)
    throw Error(ErrorCode::InvalidInput,
                "a configuration or pose is not known when the plan is carried out: it cannot be "
                "simulated");
  if (!done_.insert(std::to_string(step.node) + "\n" + before->words + after->words).second) return;
  where_ = node.acts ? action_text(model_, node.action) : "a branch";
  ++report_.steps;
  judge::CellState state = before->state;
  mounted_ = before->mounted;
  carried_.clear();
  pushed_.clear();
  grasps_.clear();
  for (std::size_t o = 0; o < before->held.size(); ++o)
    if (before->held[o]) grasps_[o] = before->held[o]->grasp;
  if (report_.steps == 1) {
    if (const auto meeting = cell_.find_meeting(state)) {
      ++report_.collisions;
      say(meeting->names[0] + " and " + meeting->names[1] + " meet at the start");
    }
  }
  std::size_t next = 0;
  for (const MotionPart& part : motions_->of(step.node, *before)) {
    const ExecutedMotion* now = next < executed.size() ? &executed[next++] : nullptr;
    if (!is_done && next == executed.size()) {
      hold(part, state);
      if (now != nullptr) look_at_executed(*now, part, state);
      return;
    }
    follow(part, state, step, now);
  }
  mounted_ = after->mounted;
  for (std::size_t o = 0; o < state.objects.size(); ++o)
    if (after->state.objects[o].away && before->state.objects[o].hold && !state.objects[o].hold &&
        !carried_.contains(o)) {
      ++report_.jumps;
      say(world_.objects[o].name + " stays where it was, and the plan says it is away");
    }
  compare(state, after->state);
  for (std::size_t o = 0; o < after->held.size(); ++o)
    if (const auto& held = after->held[o];
        held && !held->link_touches && state.objects[o].hold && grasps_[o] != held->grasp) {
      ++report_.jumps;
      say(world_.objects[o].name + " is held by another grasp than the plan says");
    }
}

/// Takes and lets go what is held from here on.
void Simulation::hold(const MotionPart& part, judge::CellState& state) {
  for (std::size_t o = 0; o < state.objects.size(); ++o) {
    judge::CellState::Place& place = state.objects[o];
    const auto wanted = part.holds.find(o);
    const bool held = place.hold && place.hold->robot == part.robot;
    if (held && (wanted == part.holds.end() || wanted->second != place.hold->link)) {
      place.pose = cell_.pose_of(state, o);
      place.hold.reset();
      pushed_.erase(o);
      if (const auto meeting = cell_.find_meeting_of(state, o)) {
        ++report_.collisions;
        say(meeting->names[0] + " and " + meeting->names[1] + " meet when one is let go");
      }
    } else if (held) {
      carried_.insert(o);
      continue;
    }
    if (wanted == part.holds.end()) continue;
    carried_.insert(o);
    const geom::Transform link = cell_.pose_of(state, part.robot, wanted->second);
    const geom::Transform pose = cell_.pose_of(state, o);
    const auto below = mounted_[o];
    const bool carried = below && part.holds.contains(*below);
    if (place.away ||
        (!carried && !is_at_grasp(world_, part.robot, wanted->second, link, o, pose))) {
      const auto way =
          pushed_way(world_, part.robot, wanted->second, link, o, pose, push_gap(part, o));
      if (way && !place.away) {
        pushed_[o] = {pose, *way, drop_of(o)};
      } else {
        ++report_.jumps;
        say(world_.objects[o].name + " is held without a grasp");
      }
    }
    const world::Attachment now = hold_of(part, world_, o, inverse(link) * pose);
    place.hold = judged(now);
    grasps_[o] = now.grasp;
  }
}

/// How far an object is above what it rests on, at most.
double Simulation::drop_of(std::size_t object) const {
  double epsilon = 0;
  for (const world::Object& o : world_.objects) epsilon = std::max(epsilon, o.outer.epsilon());
  return kMostGap + epsilon + world_.objects[object].outer.epsilon();
}

/// Between a tool and what it pushes, at most.
double Simulation::push_gap(const MotionPart& part, std::size_t object) const {
  double epsilon = 0;
  for (const world::LinkShape& shape : world_.robots[part.robot].shapes)
    if (shape.link == part.holds.at(object)) epsilon = std::max(epsilon, shape.outer.epsilon());
  return kMostGap + epsilon + world_.objects[object].outer.epsilon();
}

/// Whether all that is pushed stays on its line, and rests on something: a little lower it would
/// meet it.
void Simulation::look_at_pushed(const judge::CellState& state) {
  for (auto& [object, push] : pushed_) {
    const geom::Transform pose = cell_.pose_of(state, object);
    judge::CellState lower = state;
    lower.objects[object].hold.reset();
    lower.objects[object].pose = pose;
    lower.objects[object].pose.translation.z() -= push.drop;
    const bool straight = is_on_line(push.from, push.way, pose);
    if (straight && cell_.find_meeting_of(lower, object)) continue;
    if (push.wrong) continue;
    push.wrong = true;
    ++report_.jumps;
    say(world_.objects[object].name + (straight
                                           ? " is pushed where it rests on nothing"
                                           : " is pushed and does not stay on a straight line"));
  }
}

void Simulation::follow(const MotionPart& part, judge::CellState& state, const plan::RunStep& step,
                        const ExecutedMotion* executed) {
  if (part.path.empty() || part.path.front() != state.q[part.robot]) {
    ++report_.jumps;
    say("a path of " + world_.robots[part.robot].name + " does not begin where it is");
    if (part.path.empty()) return;
  }
  hold(part, state);
  const motion::Trajectory trajectory = trajectory_of(part, world_, options_);
  ++report_.motions;
  report_.seconds += trajectory.duration();
  if (part.blends)
    report_.blends += static_cast<std::uint64_t>(
        std::ranges::count_if(*part.blends, [](double x) { return x > 0; }));
  look(trajectory, part, state);
  if (executed != nullptr) look_at_executed(*executed, part, state);
  state.q[part.robot] = part.path.back();
  if (sink_) sink_(step, part.robot, trajectory);
}

void Simulation::look_at_executed(const ExecutedMotion& executed, const MotionPart& part,
                                  judge::CellState state) {
  if (executed.samples.empty()) return;
  const std::size_t robot = part.robot;
  SimulationOptions as_told = options_;
  as_told.motion.rate = executed.rate;
  const motion::Trajectory trajectory = trajectory_of(part, world_, as_told);
  ExecutedReport& report = report_.executed;
  ++report.motions;
  judge::CellState told = state;
  bool met = false;
  double last = 0;
  for (const ExecutedSample& sample : executed.samples) {
    if (sample.time < last) last = 0;  // tried again
    report.longest_gap = std::max(report.longest_gap, sample.time - last);
    last = sample.time;
    ++report.samples;
    state.q[robot] = sample.q;
    told.q[robot] = trajectory.at(std::min(sample.time, trajectory.duration())).q;
    for (std::size_t j = 0; j < sample.q.size(); ++j)
      report.most_strayed = std::max(report.most_strayed, std::abs(sample.q[j] - told.q[robot][j]));
    report.margin = std::max(report.margin, cell_.displacement(told, state, robot));
    if (const auto meeting = cell_.find_meeting(state, robot)) {
      ++report.collisions;
      if (!met)
        say(meeting->names[0] + " and " + meeting->names[1] + " meet as it was executed, at " +
            std::to_string(sample.time) + " s");
      met = true;
    }
  }
  report.longest_gap = std::max(report.longest_gap, trajectory.duration() - last);
}

void Simulation::look(const motion::Trajectory& trajectory, const MotionPart& part,
                      judge::CellState& state) {
  const std::size_t robot = part.robot, last = trajectory.samples() - 1;
  const motion::SpeedLimits limits = limits_of(options_, world_, robot);
  const auto sample = [&](std::size_t k) { return trajectory.sample(std::min(k, last)); };
  std::array<std::vector<double>, 4> near{sample(0), sample(0), sample(1), sample(2)};
  for (std::size_t k = 0; k <= last; ++k) {
    count_limits(robot, limits, near, part.blends.has_value());
    const std::vector<double>& now = near[1];
    state.q[robot] = now;
    if (options_.progress && report_.samples % 64 == 0)
      options_.progress(std::to_string(report_.steps) + " steps, " +
                        std::to_string(report_.samples) + " samples");
    ++report_.samples;
    if (const auto meeting = cell_.find_meeting(state, robot)) {
      if (report_.collisions++ == 0 || k == 0 || report_.problems.size() < 3)
        say(meeting->names[0] + " and " + meeting->names[1] + " meet at " +
            std::to_string(static_cast<double>(k) / trajectory.rate()) + " s");
    }
    if (!pushed_.empty()) look_at_pushed(state);
    std::shift_left(near.begin(), near.end(), 1);
    near.back() = sample(k + 3);
  }
}

/// Positions, and differences of samples: by the mean value theorem those of order 1, 2 and 3 are
/// at most the largest velocity, acceleration and jerk in between.
void Simulation::count_limits(std::size_t robot, const motion::SpeedLimits& limits,
                              const std::array<std::vector<double>, 4>& samples, bool blended) {
  const robot::Robot& kinematics = world_.robots[robot].kinematics;
  const auto& [before, now, after, next] = samples;
  const double rate = options_.motion.rate;
  bool beyond = false;
  for (std::size_t j = 0; j < now.size(); ++j) {
    const robot::Variable& v = kinematics.variables[j];
    beyond |= now[j] < v.lower.value_or(now[j]) || now[j] > v.upper.value_or(now[j]);
    const double velocity = std::abs(now[j] - before[j]) * rate / limits.velocity[j];
    const double acceleration =
        std::abs(after[j] - 2 * now[j] + before[j]) * rate * rate / limits.acceleration[j];
    report_.most_velocity = std::max(report_.most_velocity, velocity);
    report_.most_acceleration = std::max(report_.most_acceleration, acceleration);
    beyond |= velocity > 1 + kRounding || acceleration > 1 + kRounding;
    if (!blended) continue;
    const double per_jerk = rate * rate * rate / limits.jerk[j],
                 rounding = 0x1p-49 * (1 + std::abs(now[j])) * per_jerk;
    const double jerk = std::abs((next[j] - before[j]) - 3 * (after[j] - now[j])) * per_jerk;
    report_.most_jerk = std::max(report_.most_jerk, jerk);
    beyond |= jerk > 1 + kRounding + rounding;
  }
  if (!beyond) return;
  if (report_.limit_violations++ == 0)
    say(world_.robots[robot].name + " is beyond a limit of a joint");
}

/// Whether everything is where the plan says it is after a node.
void Simulation::compare(const judge::CellState& state, const judge::CellState& expected) {
  const auto wrong = [&](const std::string& what) {
    ++report_.jumps;
    say(what);
  };
  for (std::size_t r = 0; r < state.q.size(); ++r)
    if (state.q[r] != expected.q[r])
      wrong(world_.robots[r].name + " is not where the plan says it is");
  for (std::size_t o = 0; o < state.objects.size(); ++o) {
    const judge::CellState::Place &is = state.objects[o], &stated = expected.objects[o];
    const std::string& name = world_.objects[o].name;
    if (stated.away) continue;  // somebody took it away
    if (is.away) {
      wrong(name + " comes back from nowhere");
      continue;
    }
    if (!same(cell_.pose_of(state, o), cell_.pose_of(expected, o))) {
      wrong(name + " is not where the plan says it is");
      continue;
    }
    const auto held_as = [](const judge::CellState::Place& p) {
      return p.hold ? std::pair(p.hold->robot, p.hold->link) : std::pair(judge::Cell::kNone, 0U);
    };
    if (const auto below = mounted_[o]; below && !is.away && !expected.objects[*below].away) {
      const double gap =
          kMostGap + world_.objects[o].outer.epsilon() + world_.objects[*below].outer.epsilon();
      const geom::Transform pose = cell_.pose_of(expected, o),
                            under = cell_.pose_of(expected, *below);
      if (!is_on_seat(world_, o, pose, *below, under, gap) &&
          !is_mated(world_, mates_[name], o, pose, *below, under))
        wrong(name + " is neither on the seat of what it is mounted on, nor where constraints of " +
              "its mate have it");
    }
    const bool same_holder = held_as(is) == held_as(stated);
    if (same_holder && is.hold && !(is.hold->link_touches && stated.hold->link_touches) &&
        (is.hold->link_touches != stated.hold->link_touches ||
         is.hold->touching != stated.hold->touching))
      wrong(name + " is held by other pads than the plan says");
    if (same_holder) continue;
    if (stated.hold && !mounted_[o] &&
        !is_at_grasp(world_, stated.hold->robot, stated.hold->link,
                     cell_.pose_of(expected, stated.hold->robot, stated.hold->link), o,
                     cell_.pose_of(expected, o)))
      wrong(name + " is held without a grasp");
    if (const auto meeting = cell_.find_meeting_of(expected, o)) {
      ++report_.collisions;
      say(meeting->names[0] + " and " + meeting->names[1] + " meet when one is taken or let go");
    }
  }
}

}  // namespace kaboum::execution
