// Small random scenes, solved in process, and decided by brute force that shares no code with what
// solves them: no plan that does not work, no proof that there is none where there is one.

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "../actions/two_arms.h"
#include "brute_force.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using plan::Answer;

constexpr double kStep = 0.02;       // between samples of paths [rad]
constexpr double kFineStep = 0.001;  // where brute force contradicts
constexpr double kSamePose = 1e-6;
constexpr double kHighest = 0.002;  // its support things may be put down [m]

/// A call that was said to be impossible, with all that it read.
struct Refusal {
  std::string function;
  std::vector<std::string> arguments;
  std::map<std::string, std::string> read;
  bool operator<(const Refusal& o) const {
    return std::tie(function, arguments, read) < std::tie(o.function, o.arguments, o.read);
  }
};

class Recorder final : public plan::StateView {
 public:
  Recorder(plan::StateView& state, std::map<std::string, std::string>& read)
      : state_(state), read_(read) {}
  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) override {
    auto value = state_.value(function, arguments);
    if (value) read_[function + " " + arguments.at(0)] = *value;
    return value;
  }
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& arguments) override {
    return state_.truth(predicate, arguments);
  }
  bool has_term(const std::string& function, const std::vector<std::string>& arguments) override {
    return state_.has_term(function, arguments);
  }

 private:
  plan::StateView& state_;
  std::map<std::string, std::string>& read_;
};

plan::ExternalBindings recorded(const plan::ExternalBindings& all,
                                std::map<Refusal, std::string>& refusals) {
  plan::ExternalBindings out;
  for (const char* name : {"fetch", "put"}) {
    const plan::ExternalBinding inner = all.at(name);
    out[name] = [inner, name = std::string(name), &refusals](const plan::Question& q) {
      Refusal r{name, {q.arguments.begin(), q.arguments.end()}, {}};
      Recorder recorder(q.state, r.read);
      Answer answer = inner({q.arguments, recorder, q.seed, q.attempt, q.choice});
      if (answer.kind == Answer::Kind::Impossible) refusals.emplace(std::move(r), answer.reason);
      return answer;
    };
    if (inner.refuses_early()) out[name].refuse_early();
  }
  return out;
}

Transform pose_of_words(std::istringstream& words) {
  std::array<double, 7> v{};
  for (double& x : v) words >> x;
  return {Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix(),
          {v[0], v[1], v[2]}};
}

/// As the words of a state say; what was not read is away, robots are at home.
std::optional<judge::CellState> state_of(const RandomScene& scene, const Refusal& refusal) {
  judge::CellState out = scene.state();
  for (const RandomScene::Block& b : scene.blocks) out.objects[b.object].away = true;
  for (const auto& [term, value] : refusal.read) {
    const std::string thing = term.substr(term.find(' ') + 1);
    if (term.starts_with("conf")) {
      if (value != "home") return std::nullopt;
      continue;
    }
    judge::CellState::Place& place = out.objects[*scene.world.find_object(thing)];
    std::istringstream words(value);
    std::string kind, link;
    words >> kind;
    place.away = kind == "away";
    if (kind == "at") place.pose = pose_of_words(words);
    if (kind == "on") {
      words >> link;
      const std::size_t slash = link.find('/');
      const std::size_t robot = *scene.world.find_robot(link.substr(0, slash));
      place.hold = {robot, scene.hand, pose_of_words(words), {}};
    }
  }
  return out;
}

struct Count {
  int solved = 0, unsolvable = 0, listed = 0, not_found = 0;
  int refusals = 0, refusals_judged = 0, starts = 0;
  int missed = 0;  ///< not found, where brute force has a plan
  int wrong = 0;
};

class Scene {
 public:
  Scene(std::uint32_t seed, Count& count) : scene_(seed), brute_(scene_), count_(count) {
    const plan::ExternalBindings all =
        recorded(manipulation::bind_externals(scene_.world, {}), refusals_);
    const plan::Model model =
        plan::load({"task.kpl", scene_.task, plan::Language::Kpl}, nullptr, all);
    plan::SolveOptions options;
    options.algorithm = seed % 2 != 0 ? plan::Algorithm::Greedy : plan::Algorithm::BreadthFirst;
    options.attempts = 2;
    options.choices = 3;
    const plan::Solution solution = plan::solve(model, options);
    look_at_refusals();
    switch (solution.outcome) {
      case plan::Outcome::Solved:
        ++count.solved;
        replay(model, solution.plan);
        break;
      case plan::Outcome::Unsolvable:
        ++count.unsolvable;
        if (brute_.has_solution(kStep) && brute_.has_solution(kFineStep))
          wrong("unsolvable, and there is a plan; " + solution.refused);
        break;
      default:
        if (solution.limit.starts_with("with what the scene lists")) {
          ++count.listed;
          if (brute_.has_solution(kStep) && brute_.has_solution(kFineStep))
            wrong("none with what is listed, and there is a plan; " + solution.limit);
        } else {
          ++count.not_found;
          if (brute_.has_solution(kStep)) ++count.missed;
        }
    }
  }

 private:
  void wrong(const std::string& what) {
    ++count_.wrong;
    ADD_FAILURE() << what;
  }

  /// Where something is impossible, brute force finds nothing.
  void look_at_refusals() {
    for (const auto& [refusal, reason] : refusals_) {
      ++count_.refusals;
      const auto state = state_of(scene_, refusal);
      if (!state) continue;
      const std::size_t robot = *scene_.world.find_robot(refusal.arguments[0]);
      const std::size_t object = *scene_.world.find_object(refusal.arguments[1]);
      if (scene_.cell.find_meeting(*state)) {
        ++count_.starts;  // a robot is in contact before anything moves
        continue;
      }
      const judge::CellState::Place& place = state->objects[object];
      if (refusal.function == "put") {
        if (place.hold && place.hold->robot == robot)
          wrong("put is impossible from a free start: " + reason);
        continue;
      }
      if (place.away || place.hold) continue;
      ++count_.refusals_judged;
      std::size_t block = 0;
      while (scene_.blocks[block].object != object) ++block;
      for (const BruteForce::Reach& reach : brute_.free_reaches(*state, robot, block, false)) {
        std::string q;
        for (const double x : reach.q) q += " " + std::to_string(x);
        wrong("fetch of " + refusal.arguments[1] + " by " + refusal.arguments[0] +
              " is said to be impossible (" + reason + "), and is free at" + q);
      }
    }
  }

  /// Among exact meshes, every motion of a plan as it is.
  void replay(const plan::Model& model, const plan::Plan& plan) {
    const plan::CheckResult check = plan::check(model, plan);
    if (!check.valid) wrong("the plan is refuted: " + check.violation);
    judge::CellState state = scene_.state();
    std::vector<bool> removed(scene_.blocks.size()), stowed(scene_.blocks.size());
    for (plan::Index n = plan.root; n != plan::kNone; n = plan.nodes[n].next) {
      const plan::Plan::Node& node = plan.nodes[n];
      const std::string action = model.actions[node.action.schema].name;
      const std::string robot_name = model.objects[node.action.arguments[0]].name;
      const std::string block_name = model.objects[node.action.arguments[1]].name;
      const std::size_t robot = *scene_.world.find_robot(robot_name);
      const std::size_t object = *scene_.world.find_object(block_name);
      std::size_t block = 0;
      while (scene_.blocks[block].object != object) ++block;
      judge::CellState::Place& place = state.objects[object];
      const bool held = place.hold && place.hold->robot == robot;
      if (action == "drop") {
        if (!held) return wrong("what is dropped is not held");
        place.hold.reset();
        place.away = removed[block] = true;
        continue;
      }
      if (held != (action == "stow") || place.away) return wrong(action + " out of turn");
      Answer answer = Answer::found("", node.calls.at(0).payload);
      for (const Motion& motion : motions_of(answer))
        if (!follow(motion, state, robot, block)) return;
      if (action == "stow") {
        if (place.hold) return wrong("what is stowed is held");
        stowed[block] = true;
        const double above =
            place.pose.translation.z() -
            (place.pose.linear * geom::Vec3(0, 0, scene_.blocks[block].half_height)).z() -
            scene_.shelf_top.z();
        if (scene_.cell.find_meeting_of(state, object)) wrong("what is stowed meets something");
        if (!(above > 0 && above < kHighest)) wrong("what is stowed does not stand on the shelf");
      } else {
        stowed[block] = false;
        if (!place.hold) return wrong("what is picked is not held");
      }
      if (state.q[robot] != scene_.world.robots[robot].home) wrong("the robot is not at home");
    }
    for (const std::size_t b : scene_.removed)
      if (!removed[b]) wrong("the plan does not remove a block");
    for (const std::size_t b : scene_.stowed)
      if (!stowed[b]) wrong("the plan does not stow a block");
  }

  bool follow(const Motion& motion, judge::CellState& state, std::size_t robot, std::size_t block) {
    const std::size_t object = scene_.blocks[block].object;
    judge::CellState::Place& place = state.objects[object];
    if (*scene_.world.find_robot(motion.robot) != robot || motion.path.front() != state.q[robot]) {
      wrong("a motion does not begin where the robot is");
      return false;
    }
    const bool holds = motion.holds.contains(scene_.world.objects[object].name);
    if (motion.holds.size() != (holds ? 1U : 0U)) {
      wrong("a motion holds something else");
      return false;
    }
    if (!holds && place.hold) {
      place.pose = scene_.cell.pose_of(state, object);
      place.hold.reset();
    } else if (holds && !place.hold) {
      bool at = false;
      for (std::size_t g = 0; g < scene_.blocks[block].grasps.size(); ++g) {
        const judge::Hold hold = brute_.hold(robot, block, g);
        const Transform pose =
            judge::product(scene_.cell.pose_of(state, robot, scene_.hand), hold.pose);
        if ((pose.translation - place.pose.translation).norm() > kSamePose ||
            (pose.linear - place.pose.linear).cwiseAbs().maxCoeff() > kSamePose)
          continue;
        place.hold = hold;
        at = true;
        break;
      }
      if (!at) {
        wrong("no tool is at a grasp of what is taken");
        return false;
      }
    }
    for (const std::vector<double>& q : samples_of(motion.path, kStep)) {
      state.q[robot] = q;
      if (const auto meeting = scene_.cell.find_meeting(state, robot)) {
        wrong(meeting->names[0] + " and " + meeting->names[1] + " meet");
        return false;
      }
      for (std::size_t j = 0; j < q.size(); ++j) {
        const robot::Variable& v = scene_.world.robots[robot].kinematics.variables[j];
        if (q[j] < *v.lower || q[j] > *v.upper) {
          wrong("a joint is beyond its limit");
          return false;
        }
      }
    }
    return true;
  }

  RandomScene scene_;
  BruteForce brute_;
  Count& count_;
  std::map<Refusal, std::string> refusals_;
};

TEST(Scenes, VerdictsAreThoseOfBruteForce) {
  // More by hand: KABOUM_SCENES=10000; or from a seed on, KABOUM_FIRST_SCENE.
  const auto from_environment = [](const char* name, std::uint32_t otherwise) {
    const char* const text = std::getenv(name);
    return text == nullptr ? otherwise : static_cast<std::uint32_t>(std::atoi(text));
  };
  const std::uint32_t scenes = from_environment("KABOUM_SCENES", 120);
  const std::uint32_t first = from_environment("KABOUM_FIRST_SCENE", 0);
  Count count;
  for (std::uint32_t seed = first; seed < first + scenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Scene scene(seed, count);
  }
  const std::string all = "solved " + std::to_string(count.solved) + ", unsolvable " +
                          std::to_string(count.unsolvable) + ", none with what is listed " +
                          std::to_string(count.listed) + ", not found " +
                          std::to_string(count.not_found) + " (brute force has a plan of " +
                          std::to_string(count.missed) + "); impossible calls " +
                          std::to_string(count.refusals) + ", judged " +
                          std::to_string(count.refusals_judged) + ", starts in contact " +
                          std::to_string(count.starts) + "; wrong " + std::to_string(count.wrong);
  RecordProperty("verdicts", all);
  std::cout << all << "\n";
  if (scenes < 100) return;
  EXPECT_GT(count.solved, static_cast<int>(scenes) / 10);
  EXPECT_GT(count.unsolvable, static_cast<int>(scenes) / 50);
  EXPECT_GT(count.listed, static_cast<int>(scenes) / 50);
  EXPECT_GT(count.refusals_judged, static_cast<int>(scenes) / 10);
}

}  // namespace
}  // namespace kaboum::test
