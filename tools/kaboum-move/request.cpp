// What kaboum-move is asked for, and what it says of the answer.

#include "request.h"

#include <kaboum/base/error.h>
#include <kaboum/motion/goals.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/world/gripper.h>

#include "common/check_report.h"

namespace kaboum::tools {

using motion::PathAnswer;
using Outcome = PathAnswer::Outcome;

namespace {

[[noreturn]] void usage(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

/// "0,1.5,-2": a value per variable.
std::vector<double> configuration(const std::string& text, const char* option, const MoveOptions& o,
                                  const robot::Robot& robot) {
  try {
    robot::Path path = arrange(robot::parse_path_csv(text, option), robot, option, false, {});
    if (path.size() != 1) usage(std::string(option) + ": one configuration is expected");
    if (o.degrees) path = robot::from_degrees(std::move(path), robot);
    robot::require_within_limits(path, robot, option);
    return path.front();
  } catch (const Error& error) {
    usage(error.what());  // the command line's fault, no file's
  }
}

/// The goals of a file. Those beyond the joints' limits are left out with a note: others may do.
void add_goals(MoveRequest& r, robot::Path goals, const MoveOptions& o) {
  const std::string& file = o.goals;
  const std::size_t given = o.to.size() + o.to_pose.size() + o.reach.size();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (const auto bad = find_out_of_limits(r.kinematics(), goals[i])) {
      r.notes.push_back(file + ": goal " + std::to_string(i + 1) + " is left out: joint '" +
                        r.kinematics().variables[*bad].name + "' is outside its limits");
    } else {
      r.goals.push_back(std::move(goals[i]));
      r.numbers.push_back(given + i + 1);
    }
  }
  if (r.goals.empty())
    throw Error(ErrorCode::InvalidInput, file + ": all goals are outside the joints' limits");
}

/// The configurations with which the tool has the poses that are asked for.
void add_pose_goals(MoveRequest& r, const MoveOptions& o) {
  if (o.to_pose.empty()) return;  // no tool need be known then
  const world::ToolFrame tool = motion::moving_frame(r.model(), o.keep.tool);
  std::size_t number = o.to.size();
  for (const std::string& text : o.to_pose) {
    ++number;
    const geom::Transform pose = robot::parse_pose(text, "--to-pose");
    const motion::Goals goals = motion::pose_goals(r.model(), tool, pose, r.start, o.search.seed);
    r.all_known = r.all_known && goals.complete;
    for (const std::vector<double>& q : goals.configurations) {
      r.goals.push_back(q);
      r.numbers.push_back(number);
    }
    if (!goals.configurations.empty()) continue;
    const std::string why = "--to-pose " + text + ": no configuration within the limits puts '" +
                            tool.name + "' there" +
                            (goals.complete ? "" : ", as far as was found: " + goals.why);
    r.unreached.push_back(why);
  }
}

/// Configurations that meet the constraints that are asked for.
void add_constraint_goals(MoveRequest& r, const MoveOptions& o) {
  std::size_t number = o.to.size() + o.to_pose.size();
  for (const std::string& name : o.reach) {
    ++number;
    r.all_known = false;  // they are drawn
    const motion::Goals goals = motion::preferred_goals(
        r.scene.world, r.robot, motion::moving_frame(r.model(), o.keep.tool),
        r.scene.world.constraint_set(name), r.start, o.search.seed);
    for (const std::vector<double>& q : goals.configurations) {
      r.goals.push_back(q);
      r.numbers.push_back(number);
    }
    if (!goals.configurations.empty()) continue;
    r.unreached.push_back("--reach " + name +
                          ": no configuration was found that meets these constraints, which does "
                          "not say that there is none");
  }
}

/// Fingers that hold something are where the grasp has them, from the start to each goal.
void require_fingers(MoveRequest& r, const MoveOptions& o) {
  const auto& attachments = r.scene.world.attachments;
  if (world::holding_joints(r.robot, attachments).empty()) return;
  if (!o.roadmap.empty())
    usage("--roadmap: robot '" + r.model().name +
          "' holds something by a gripper with joints, which stay where they hold it; edges of a "
          "roadmap move all joints: leave it out");
  robot::Path ends{r.start};
  ends.insert(ends.end(), r.goals.begin(), r.goals.end());
  static_cast<void>(
      world::finger_room_along(r.scene.world, r.robot, attachments, {&r.start, 1}, "the start"));
  static_cast<void>(world::finger_room_along(r.scene.world, r.robot, attachments, r.goals, "goal"));
  r.around = world::finger_room_along(r.scene.world, r.robot, attachments, ends, "waypoint");
}

bool is_certain(const PathAnswer& answer) {
  return answer.broken->outcome == motion::ConstraintAnswer::Outcome::Broken;
}

Json blockers_json(const world::World& world, const PathAnswer& answer) {
  Json out = Json::array();
  for (const motion::Blocker& b : answer.blockers)
    out.push_back(
        {{"pair", {world.name_of(b.items[0]), world.name_of(b.items[1])}}, {"times", b.times}});
  return out;
}

}  // namespace

MoveRequest read_request(const MoveOptions& o) {
  MoveRequest r;
  r.scene = world::read_scene(o.scene);
  r.scene.world.margins = world::margins_of(r.scene.world, o.margin);
  r.notes = r.scene.notes;
  r.robot = world::robot_named(r.scene.world, o.robot);
  const robot::Robot& robot = r.kinematics();
  const auto read = [&](const std::string& file, bool limits) {
    return robot::read_path(file, robot, {limits, o.degrees, {}}, r.notes);
  };
  r.start = !o.start.empty()  ? read(o.start, true).back()
            : !o.from.empty() ? configuration(o.from, "--from", o, robot)
                              : initial_state(r.scene.world).q[r.robot];
  for (const std::string& text : o.to) {
    r.goals.push_back(configuration(text, "--to", o, robot));
    r.numbers.push_back(r.goals.size());
  }
  add_pose_goals(r, o);
  add_constraint_goals(r, o);
  if (!o.goals.empty()) add_goals(r, read(o.goals, false), o);
  if (r.goals.empty()) {
    if (r.unreached.empty())
      usage("where to? Give --to Q1,Q2,…, --to-pose POSE, --reach NAME or --goals FILE");
    return r;
  }
  require_fingers(r, o);
  r.notes.insert(r.notes.end(), r.unreached.begin(), r.unreached.end());
  r.constraints = motion::constraints_of(r.scene.world, initial_state(r.scene.world), r.robot,
                                         r.start, r.goals, o.keep);
  return r;
}

Json answer_json(const MoveRequest& r, const PathAnswer& answer, const MoveOptions& o) {
  const motion::Spent& s = answer.spent;
  Json out = {{"scene", {{"file", o.scene}, {"sha256", r.scene.sha256}}},
              {"robot", r.model().name},
              {"outcome", name_of(answer.outcome)},
              {"seed", o.search.seed},
              {"start", r.start},
              {"goals", r.goals.size()},
              {"spent",
               {{"work", s.work},
                {"configurations", s.configurations},
                {"motions", s.motions},
                {"intervals", s.intervals},
                {"samples", s.samples},
                {"nodes", s.nodes}}},
              {"blockers", blockers_json(r.scene.world, answer)}};
  if (answer.outcome == Outcome::Found) {
    out["goal"] = r.numbers[answer.goal];
    out["straight"] = answer.straight;
    out["waypoints"] = answer.path;
  }
  if (!r.constraints.empty()) {
    out["kept"] = Json::array();
    for (std::size_t i = 0; i < r.constraints.size(); ++i) {
      out["kept"].push_back(to_json(r.kinematics(), r.constraints[i]));
      if (i < answer.deviations.size()) out["kept"].back()["used"] = answer.deviations[i];
    }
  }
  if (answer.broken) out["broken"] = describe(*answer.broken, r.constraints);
  if (!o.margin.margins.empty()) out["margins"] = words_of(o.margin);
  if (answer.contact) out["contact"] = to_json(r.scene.world, *answer.contact);
  return out;
}

std::string reason(const MoveRequest& r, const PathAnswer& answer) {
  const world::World& world = r.scene.world;
  if (answer.outcome == Outcome::StartInContact)
    return "the start is not free: " + describe(world, *answer.contact);
  const std::string tried =
      r.all_known ? "" : "; these need not be all configurations that reach what is asked for";
  if (answer.outcome == Outcome::GoalInContact)
    return std::string(r.goals.size() > 1 ? "no goal is free: " : "the goal is not free: ") +
           describe(world, *answer.contact) + tried;
  if (answer.broken) {
    const bool start = answer.outcome == Outcome::StartBreaksConstraint;
    return std::string(start                ? "the start"
                       : r.goals.size() > 1 ? "every goal that is free"
                                            : "the goal") +
           (is_certain(answer) ? " breaks a constraint: "
                               : " does not certainly keep a constraint: ") +
           describe(*answer.broken, r.constraints) + (start ? "" : tried);
  }
  std::string out = "no path found, which does not say that there is none: the search ended by ";
  out += answer.outcome == Outcome::WorkEnded    ? "--max-work"
         : answer.outcome == Outcome::NodesEnded ? "--max-nodes"
                                                 : "--timeout";
  if (!answer.blockers.empty()) {
    const motion::Blocker& b = answer.blockers.front();
    out += "; most often in the way: " + world.name_of(b.items[0]) + " and " +
           world.name_of(b.items[1]);
  }
  return out;
}

int exit_code(const MoveRequest& r, const PathAnswer& answer) {
  const bool start =
      answer.outcome == Outcome::StartInContact || answer.outcome == Outcome::StartBreaksConstraint;
  const bool goal =
      answer.outcome == Outcome::GoalInContact || answer.outcome == Outcome::GoalBreaksConstraint;
  const bool certain = !answer.broken || is_certain(answer);
  return certain && (start || (goal && r.all_known)) ? kNo : kLimit;
}

}  // namespace kaboum::tools
