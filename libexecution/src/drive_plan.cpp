// Plans carried out by a robot driver: told step by step, sensed on the way, planned again.

#include <kaboum/base/error.h>
#include <kaboum/execution/drive_plan.h>
#include <kaboum/plan/check.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <set>

#include "finger_motion.h"
#include "node_events.h"
#include "node_motions.h"
#include "run_notes.h"
#include "simulation_state.h"

namespace kaboum::execution {
namespace {

using Kind = DriverStop::Kind;

/// The plans of a run, as they are told to a driver.
class Drive {
 public:
  Drive(const world::World& world, const judge::Cell& cell, const PlanRunRequest& request,
        const DriverOptions& options, DriveReport& report)
      : world_(world),
        cell_(cell),
        request_(request),
        driver_(world, options),
        notes_(world),
        report_(report) {
    told_options_ = request.simulation;
    told_options_.motion.rate = options.rate;
    told_options_.progress = {};
  }

  /// @throws DriverStop for a plan that does not hold
  std::function<void(const plan::RunStep&)> take_up(const plan::Model& model,
                                                    const plan::Plan& plan) {
    const auto missing =
        request_.replan.most > 0 ? plan::MissingCases::PlannedAgain : plan::MissingCases::Refused;
    if (const plan::CheckResult checked = plan::check(model, plan, plan::kMostStates, {}, missing);
        !checked.valid)
      throw DriverStop(Kind::Uncertified, "the plan does not hold: " + checked.violation);
    done_.emplace_back(world_, model, plan, told_options_);
    if (driver_.is_noted()) driver_.note(notes_.plan(model, plan));
    prepare(done_.back());
    model_ = &done_.back().model;
    plan_ = &done_.back().plan;
    told_.reset();
    return [this](const plan::RunStep& step) {
      tell(step.node, step.before);
      settle(step.after);
      done_.back().nodes.insert(step.node);
      if (driver_.is_noted()) driver_.note(notes_.done(step, *end_));
    };
  }

  std::string sense(const plan::SensedFact& what) {
    tell(what.node, what.before);
    std::string said = driver_.sense(what.fact, what.values);
    if (std::ranges::find(what.values, said) == what.values.end()) {
      std::string values;
      for (const std::string& v : what.values) values += (values.empty() ? "" : ", ") + v;
      throw DriverStop(Kind::Nonsense, what.fact + " was sensed to be '" + said +
                                           "'; by what is known it is one of " + values);
    }
    done_.back().sensed.push_back(said);
    return said;
  }

  void finish() { driver_.finish(end_ ? &*end_ : nullptr); }

  void note_planning(const plan::Unplanned& why, unsigned after) {
    driver_.note(RunNotes::planning(why, after));
  }
  void note_planned(const plan::Replan& replan) { driver_.note(RunNotes::planned(replan)); }
  /// That it has ended otherwise than at the goal.
  void note_end(const std::string& kind, const std::string& why) { driver_.end(kind, why); }
  /// Tells the robot to stand still, unless the plan has come to its end.
  void stop() { driver_.stop(); }
  /// What comes of it, judged by exact meshes. @pre it is stopped and closed
  void note_verdict() {
    driver_.note(RunNotes::verdict(report_));
    report_.not_noted = driver_.not_noted();
  }

  /// What is to be said however it ends. All that was done to its end is judged by exact meshes.
  void close() {
    for (Done& done : done_) {
      Simulation simulation(world_, cell_, done.model, done.plan, request_.simulation, {},
                            done.motions);
      std::size_t next = 0;
      plan::RunOptions again;
      again.outcomes = plan::RunOptions::Outcomes::Asked;
      // Where it stopped, nothing was sensed any more: what follows is not among the nodes.
      again.sense = [&](const plan::SensedFact& what) {
        return next < done.sensed.size() ? done.sensed[next++] : what.values.front();
      };
      again.unplanned = [](const plan::Unplanned&) {};
      plan::run(done.model, done.plan, again, [&](const plan::RunStep& step) {
        const std::vector<ExecutedMotion>& executed = done.executed[step.node];
        if (done.nodes.contains(step.node))
          simulation.carry_out(step, executed);
        else if (!executed.empty())  // where it stopped
          simulation.begin(step, executed);
      });
      report_.run.simulation += simulation.report();
    }
    report_.messages = driver_.messages();
    report_.waited = driver_.waited();
    report_.between = driver_.between();
    report_.most_tracking = driver_.most_tracking();
  }

 private:
  /// A motion as it is told.
  struct ToldMotion {
    motion::Trajectory trajectory;
    std::string text;
  };

  /// A plan as far as it was carried out.
  struct Done {
    Done(const world::World& world, const plan::Model& m, const plan::Plan& p,
         const SimulationOptions& options)
        : model(m), plan(p), motions(std::make_shared<NodeMotions>(world, model, plan, options)) {}
    plan::Model model;
    plan::Plan plan;
    std::shared_ptr<NodeMotions> motions;  ///< of the plan here
    std::map<const MotionPart*, ToldMotion> told = {};
    std::set<plan::Index> nodes = {};
    std::map<plan::Index, std::vector<ExecutedMotion>> executed = {};  ///< by node
    std::vector<std::string> sensed = {};                              ///< in their order
  };

  const ToldMotion& told(Done& done, const MotionPart& part) const {
    const auto found = done.told.find(&part);
    if (found != done.told.end()) return found->second;
    motion::Trajectory trajectory = trajectory_of(part, world_, told_options_);
    std::string text = told_trajectory(world_.robots[part.robot].kinematics, trajectory);
    return done.told.emplace(&part, ToldMotion{std::move(trajectory), std::move(text)})
        .first->second;
  }

  /// Has the motions that the plan may come to certified, and put into words, before the first one
  /// is told: a step does not wait for that then. Where there are many, the others follow when it
  /// comes to them.
  void prepare(Done& done) const {
    constexpr std::uint64_t kMostStates = 10'000;
    constexpr std::size_t kMostBytes = 256'000'000;
    if (request_.simulation.progress) request_.simulation.progress("certifying motions");
    plan::RunOptions every;
    every.unplanned = [](const plan::Unplanned&) {};
    every.most_states = kMostStates;
    std::size_t bytes = 0;
    bool in_motion = false;
    try {
      plan::run(done.model, done.plan, every, [&](const plan::RunStep& step) {
        const auto state = state_of(world_, done.model, step.before);
        if (!state) return;
        in_motion = true;
        for (const MotionPart& part : done.motions->of(step.node, *state))
          if (!part.path.empty() && bytes < kMostBytes) bytes += told(done, part).text.size();
        in_motion = false;
      });
    } catch (const Error& e) {
      if (in_motion || e.code() != ErrorCode::LimitReached) throw;  // that of states is expected
    }
  }

  [[nodiscard]] StatedState known_state(const plan::KnownState& known) const {
    auto state = state_of(world_, *model_, known);
    if (!state)
      throw Error(ErrorCode::InvalidInput,
                  "a configuration or pose is not known when the plan is carried out: no robot can "
                  "be told");
    return std::move(*state);
  }

  /// Tells the motions of a node, once.
  void tell(plan::Index node, const plan::KnownState& before) {
    if (told_ == node) return;
    told_ = node;
    const StatedState known = known_state(before);
    const judge::CellState& state = known.state;
    if (!begun_) {
      begun_ = true;
      q_ = state.q;
      driver_.begin(state, known.held);
      held_ = held_in(state);
    }
    const plan::Plan::Node& n = plan_->nodes[node];
    const std::string action = n.acts ? action_text(*model_, n.action) : "";
    if (driver_.is_noted()) driver_.note(notes_.begun(node, action, state, before));
    if (!n.acts) return;
    if (request_.simulation.progress) request_.simulation.progress(action);
    ++report_.actions;
    driver_.act(action);
    const std::vector<MotionPart>& parts = done_.back().motions->of(node, known);
    require_joined(parts, action);
    for (const NodeEvent& event : motion_events(parts, held_)) {
      if (event.kind != NodeEvent::Kind::Move && !event.moves_fingers) {
        hold(event);
        continue;
      }
      const MotionPart& part = parts[event.motion];
      if (event.moves_fingers) {
        done_.back().executed[node].emplace_back();  // it does not say how fingers moved
        hold(event, finger_motion_of(part, world_));
        q_[part.robot] = part.path.back();
        continue;
      }
      const ToldMotion& motion = told(done_.back(), part);
      driver_.move(part.robot, motion.trajectory, motion.text,
                   done_.back().executed[node].emplace_back());
      q_[part.robot] = part.path.back();
    }
  }

  /// Each motion begins where the robot is then.
  void require_joined(const std::vector<MotionPart>& parts, const std::string& action) const {
    std::vector<std::vector<double>> q = q_;
    for (const MotionPart& part : parts) {
      if (part.path.empty() || part.path.front() != q[part.robot])
        throw DriverStop(Kind::Uncertified, action + ": a path of " +
                                                world_.robots[part.robot].name +
                                                " does not begin where it is");
      q[part.robot] = part.path.back();
    }
  }

  /// Takes and lets go what the state after a node says. Fingers do not move any more.
  void settle(const plan::KnownState& after) {
    const StatedState known = known_state(after);
    end_ = known.state;
    for (std::size_t r = 0; r < world_.robots.size(); ++r)
      for (const world::Gripper& gripper : world_.robots[r].grippers)
        for (const std::uint32_t variable : gripper.joints)
          if (known.state.q[r][variable] != q_[r][variable])
            throw DriverStop(Kind::Uncertified,
                             "the joint '" + world_.robots[r].kinematics.variables[variable].name +
                                 "' of " + world_.robots[r].name +
                                 "'s gripper is not where what it holds has it: no motion of the "
                                 "plan closes or opens it");
    for (const NodeEvent& event : settling_events(*end_, held_)) {
      const auto& held = known.held[event.object];
      const std::vector<double>& q = q_[event.by.robot];
      if (event.kind == NodeEvent::Kind::Take && held && !held->fingers.empty())
        hold(event, finger_motion_of(*held, world_, q, q));
      else
        hold(event);
    }
    driver_.require_fingers(known.held);
  }

  void hold(const NodeEvent& event, const FingerMotion& fingers = {}) {
    if (event.other_link)
      throw DriverStop(Kind::Uncertified, world_.objects[event.object].name +
                                              " goes from one link to another of " +
                                              world_.robots[event.by.robot].name);
    if (event.kind == NodeEvent::Kind::Take)
      driver_.take(event.object, event.by.robot, event.by.link, fingers);
    else
      driver_.release(event.object, event.by.robot, fingers);
  }

  const world::World& world_;
  const judge::Cell& cell_;
  const PlanRunRequest& request_;
  RobotDriver driver_;
  RunNotes notes_;
  SimulationOptions told_options_;  ///< of the motions as they are told
  DriveReport& report_;
  const plan::Model* model_ = nullptr;
  const plan::Plan* plan_ = nullptr;
  std::optional<plan::Index> told_;  ///< the node whose motions were told last
  bool begun_ = false;
  std::vector<std::vector<double>> q_;
  Held held_;
  std::optional<judge::CellState> end_;  ///< of what was carried out last
  std::deque<Done> done_;
};

}  // namespace

DriveReport drive_plan(const PlanningTask& task, const plan::Model& model, const plan::Plan& plan,
                       const PlanRunRequest& request, const DriverOptions& options) {
  using Clock = std::chrono::steady_clock;
  if (task.scene() == nullptr)
    throw Error(ErrorCode::InvalidArgument, "a plan is carried out in a scene; there is none");
  if (!plan.not_certified.empty())
    throw Error(ErrorCode::InvalidArgument,
                "contacts of the plan are " + plan.not_certified +
                    ": no robot is moved by it; plan it with own predicates");
  const world::World& world = task.scene()->world;
  DriveReport out;
  out.run.plans.run.branches = 1;
  const judge::Cell cell = exact_cell(world, task.files().scene, request.packages, out.run.notes);
  out.run.triangles = cell.triangles();
  const auto start = Clock::now();
  std::optional<Drive> drive;
  plan::ReplanOptions replan = request.replan;
  replan.run.outcomes = plan::RunOptions::Outcomes::Asked;
  replan.run.sense = [&](const plan::SensedFact& what) { return drive->sense(what); };
  const plan::StepsOf steps = [&](const plan::Model& m, const plan::Plan& p) {
    return drive->take_up(m, p);
  };
  replan.planning = [&](const plan::Unplanned& why, unsigned after) {
    drive->note_planning(why, after);
    if (request.replan.planning) request.replan.planning(why, after);
  };
  replan.planned = [&](const plan::Replan& made) {
    drive->note_planned(made);
    if (request.replan.planned) request.replan.planned(made);
  };
  try {
    drive.emplace(world, cell, request, options, out);
    if (replan.most == 0)
      out.run.plans.run = plan::run(model, plan, replan.run, steps(model, plan));
    else
      out.run.plans = plan::run_and_replan(task.texts(), model, plan, replan, steps);
    if (out.run.plans.complete()) {
      // A run ends as well where what an action observes contradicts what is known.
      if (out.run.plans.run.ends != 1)
        throw DriverStop(Kind::Uncertified,
                         "what the next action observes contradicts what is known: the plan has "
                         "not come to its end");
      drive->finish();
    } else {
      drive->note_end("no plan", out.run.plans.replans.back().reason);
    }
  } catch (const DriverStop& stop) {
    out.stopped = stop.kind();
    out.reason = stop.what();
    if (drive) drive->note_end(name_of(stop.kind()), stop.what());
  } catch (const std::exception& error) {
    if (drive) drive->note_end("error", error.what());
    throw;
  }
  out.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (!drive) {
    if (out.stopped == Kind::Journal) out.not_noted = out.reason;
    return out;
  }
  drive->stop();  // it is not to wait for what follows
  drive->close();
  drive->note_verdict();
  return out;
}

}  // namespace kaboum::execution
