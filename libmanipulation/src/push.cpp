// Pushing an object that stands on another one along a straight line
// (docs/planning/geometry.md, "Pushing"). Source: [gaschler2016] §5.2, Fig. 5.3.
#include <kaboum/base/error.h>
#include <kaboum/base/radical_inverse.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>

#include <algorithm>

#include "push_contact.h"
#include "sequence.h"

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Between two waypoints of the line. [m]
constexpr double kStep = 0.01;
/// Pushes are no shorter. [m]
constexpr double kShortest = 0.02;
/// How far the tool backs off afterwards. [m]
constexpr double kBackOff = 0.03;
/// Distances that are tried from each side; with each attempt as many more.
constexpr std::size_t kDistances = 8;

/// 1, 1/2, 1/4, 3/4, 1/8, …: all the way first, then van der Corput's sequence.
double share_of(std::size_t index) { return index == 0 ? 1 : radical_inverse(index, 2); }

/// @throws Error{InvalidInput} when no joint moves the link.
void require_moving(const world::RobotModel& robot, const world::LinkFeature& front) {
  const std::vector<robot::Joint>& joints = robot.kinematics.joints;
  for (std::uint32_t link = front.link; link != 0; link = joints[link - 1].parent)
    if (joints[link - 1].type != robot::JointType::Fixed) return;
  throw Error(ErrorCode::InvalidInput,
              "robot '" + robot.name + "' of the scene: no joint moves the link '" +
                  robot.kinematics.links[front.link].name + "' of the plane '" +
                  front.feature.name + "', which pushing needs");
}

}  // namespace

/// Contacts of a side at which the robot is free, and how far the object may be pushed from it.
struct Sequence::PushSide {
  struct Start {
    PushContact contact;
    std::vector<double> q;
  };
  std::vector<Start> starts;
  double farthest = 0;
};

std::vector<Sequence::PushSide> Sequence::push_sides(std::size_t robot, std::size_t object,
                                                     const PushedObject& pushed) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const world::Object& thing = geometry_.world.objects[object];
  const Transform at = pose_of_object(object);
  const std::vector<double> angles = turns();
  std::vector<PushSide> out;
  const bool has_front = std::ranges::any_of(
      model.features, [](const world::LinkFeature& f) { return is_for_pushing(f.feature); });
  bool listed = false, upright = false, possible = false, reached = false;
  for (const world::Feature& side : thing.features) {
    if (!is_for_pushing(side)) continue;
    listed = true;
    const auto direction = push_direction(at, side, pushed.center());
    if (!direction) continue;
    upright = true;
    PushSide& found = out.emplace_back();
    found.farthest = pushed.farthest(*direction);
    if (found.farthest < kShortest) continue;
    possible = true;
    for (const world::LinkFeature& front : model.features) {
      if (!is_for_pushing(front.feature)) continue;
      require_moving(model, front);
      for (const double angle : angles) {
        const auto contact = push_contact(model, front, thing, at, side, *direction,
                                          pushed.center(), angle, geometry_.options.clearance);
        if (!contact) continue;
        Goals goals;
        add_goals(goals, robot, contact->link, contact->link_pose);
        for (std::vector<double>& q : goals.configurations) {
          reached = true;
          if (is_free_at(robot, q)) found.starts.push_back({*contact, std::move(q)});
        }
      }
    }
  }
  std::erase_if(out, [](const PushSide& side) { return side.starts.empty(); });
  if (!out.empty()) return out;
  if (!has_front || !possible) {
    fail(Answer::Kind::Impossible,
         !has_front ? "the scene lists no planes 'push…' of " + model.name
         : !listed  ? "the scene lists no planes 'push…' of " + thing.name
         : !upright
             ? "no plane 'push…' of " + thing.name + " is upright with its centre ahead of it"
             : thing.name + " cannot be pushed 2 cm from any of its planes 'push…' and " +
                   "stay where it stands");
    listed_ = true;
    return {};
  }
  fail(Answer::Kind::NotFound,
       reached ? "no way to push " + thing.name + " that was tried begins free of contact"
               : thing.name + " was not found to be in reach of a push");
  return {};
}

/// Along a straight line, if all of it is certain; what was done is undone where it is not.
bool Sequence::push_along(std::size_t robot, std::size_t object, const PushedObject& pushed,
                          const PushContact& contact, const std::vector<double>& q, double length) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const std::string& name = geometry_.world.objects[object].name;
  const world::WorldState before = state_;
  const std::vector<std::optional<std::size_t>> mounted = mounted_;
  const std::vector<Motion> motions = motions_;
  const std::vector<robot::Path> last_paths = last_paths_;
  const auto undo = [&](const std::string& reason) {
    state_ = before;
    mounted_ = mounted;
    motions_ = motions;
    last_paths_ = last_paths;
    return fail(Answer::Kind::NotFound, reason);
  };
  const auto line_to = [&](const Transform& link) {
    auto line = follow_line(model, contact.link, state_.q[robot], link, kStep);
    if (line)
      line->back() =
          with_fingers(robot, configuration_of(manipulation::word_of(line->back()), model));
    return line;
  };
  const Transform at = pose_of_object(object);
  state_.q[robot] = q;
  Transform end = contact.link_pose;
  end.translation += length * contact.direction;
  const auto line = line_to(end);
  if (!line) return undo("the tool cannot follow a straight line to push " + name);
  world::Attachment held;
  held.robot = robot;
  held.link = contact.link;
  held.pose = inverse(pose_of_link(robot, contact.link)) * at;
  held =
      *place_of(manipulation::word_of(geometry_.world, held), geometry_.world, object).attachment;
  if (motion::check_constraints(
          model, *line, push_constraints(held, at, pushed.center(), contact.direction, length))
          .outcome != motion::ConstraintAnswer::Outcome::Kept)
    return undo(name + " would leave its straight line");
  carry(object, held, {});
  if (!may_follow(robot, *line)) return undo(name + " is not free to be pushed");
  // It can be pushed so: now from where the robot is.
  state_ = before;
  Goals goals;
  goals.configurations = {q};
  goals.all = false;
  if (!go(robot, goals)) return undo(reason_);
  carry(object, held, {});
  record(robot, *line);
  Transform pose = at;
  pose.translation += length * contact.direction;
  target_ = Target{object, pose, std::nullopt, contact.link, 0};
  if (!let_go(robot, object)) return undo(reason_);
  Transform back = end;
  back.translation -= kBackOff * contact.direction;
  const auto away = line_to(back);
  if (!away || !may_follow(robot, *away)) return undo("the tool does not back off from " + name);
  record(robot, *away);
  chosen_ = true;
  return true;
}

bool Sequence::push(std::size_t robot, std::size_t object, std::size_t support) {
  const world::World& world = geometry_.world;
  const world::Object &thing = world.objects[object], &below = world.objects[support];
  const auto never = [&](const std::string& reason) {
    return fail(Answer::Kind::Impossible, reason);
  };
  if (state_.absent[object]) return never(thing.name + " is away");
  if (support == object || state_.absent[support])
    return never(below.name + " is not there to be pushed on");
  if (state_.attachments[object] || mounted_[object])
    return never(thing.name + " does not rest, as what is pushed does");
  for (std::size_t o = 0; o < world.objects.size(); ++o)
    if (held_by(robot, o) && !state_.absent[o])
      return never(world.robots[robot].name + " holds " + world.objects[o].name +
                   ": its hand is not free to push");
  const PushedObject pushed(thing, pose_of_object(object), below, pose_of_object(support),
                            geometry_.options.clearance);
  if (!pushed.refusal().empty()) {
    never(pushed.refusal());
    listed_ = true;  // by the scene's sets
    return false;
  }
  const std::vector<PushSide> sides = push_sides(robot, object, pushed);
  if (sides.empty()) return false;
  // One side after the other, then the next distance; a choice begins farther on.
  const std::size_t draws = sides.size() * kDistances * (question_.attempt + 1);
  choices_ = std::max(choices_, static_cast<unsigned>(sides.size() * kDistances - 1));
  fail(Answer::Kind::NotFound, thing.name + " can be pushed nowhere");
  for (std::size_t i = 0; i < draws; ++i) {
    const std::size_t draw = (i + question_.choice) % draws;
    const PushSide& side = sides[draw % sides.size()];
    const double length = side.farthest * share_of(draw / sides.size());
    if (length < kShortest) continue;
    for (const PushSide::Start& start : side.starts)
      if (push_along(robot, object, pushed, start.contact, start.q, length)) return true;
  }
  reason_ = std::to_string(draws) + " pushes of " + thing.name + " on " + below.name +
            " were tried; the last: " + reason_;
  return false;
}

}  // namespace kaboum::manipulation
