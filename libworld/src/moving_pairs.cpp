// Pairs of things that move against each other: how fast, and where they are at an instant.

#include "moving_pairs.h"

#include <kaboum/robot/kinematics.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/margins.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace kaboum::world::detail {
namespace {

/// The links from the root to one, itself included.
std::vector<std::uint32_t> chain(const robot::Robot& robot, std::uint32_t link) {
  std::vector<std::uint32_t> out;
  for (;; link = robot.joints[link - 1].parent) {
    out.push_back(link);
    if (link == 0) break;
  }
  std::reverse(out.begin(), out.end());
  return out;
}

/// Ends of the segment with the variables held that move what both links hang from, so that only
/// their motion relative to it counts. Unchanged where such a variable moves one of them as well.
std::vector<double> held(const robot::Robot& robot, std::uint32_t a, std::uint32_t b,
                         const std::vector<double>& from, const std::vector<double>& to) {
  const auto x = chain(robot, a), y = chain(robot, b);
  std::size_t common = 0;
  while (common < x.size() && common < y.size() && x[common] == y[common]) ++common;
  const auto& joints = robot.joints;
  std::vector<double> out = to;
  const auto moved_by = [&](std::uint32_t link) {
    return joints[link - 1].type == robot::JointType::Fixed ? out.size()
                                                            : joints[link - 1].variable;
  };
  std::vector<char> below(out.size() + 1, 0);
  for (const auto* links : {&x, &y})
    for (std::size_t i = common; i < links->size(); ++i) below[moved_by((*links)[i])] = 1;
  for (std::size_t i = 1; i < common; ++i) {
    const std::size_t variable = moved_by(x[i]);
    if (variable == out.size()) continue;
    if (below[variable] != 0) return to;
    out[variable] = from[variable];
  }
  return out;
}

/// How far a shape of a robot that rests may be from where it is computed to be: its fingers stop
/// where they touch what they hold.
double room_at_rest(const Checker& checker, const WorldState& state, const Item& item) {
  if (item.robot == Item::kObject) return 0;
  const World& world = checker.world();
  const std::vector<double> around = finger_room(world, item.robot, state.attachments);
  if (around.empty()) return 0;
  const RobotModel& model = world.robots[item.robot];
  const std::vector<double>& q = state.q[item.robot];
  const auto [base, out] = outward(q, q, around);
  const sweep::LinkMotion motion(model.kinematics, model.shapes[item.index].link, base, out);
  if (!motion.moves()) return 0;
  return sweep::MotionBounds(motion, checker.reach_of(item.robot, item.index)).derivative(1) * kUp;
}

}  // namespace

MovingPairs::MovingPairs(const Checker& checker, const WorldState& state,
                         std::vector<MovingRobot> robots, Scratch* scratch,
                         const std::vector<Item>* things)
    : checker_(checker), world_(checker.world()), robots_(std::move(robots)) {
  WorldState start = state;
  for (const auto& [robot, path, around] : robots_) {
    start.q[robot] = path->front();
    // A path that leaves the limits makes pairs count that are proved apart within them.
    for (const std::vector<double>& q : *path)
      for (const double side : {0.0, -1.0, 1.0}) {
        if (side != 0 && (around == nullptr || around->empty())) continue;
        std::vector<double> near = q;
        for (std::size_t i = 0; side != 0 && i < q.size(); ++i) near[i] += side * (*around)[i];
        if (!checker_.is_within_limits(robot, near)) start.q[robot] = std::move(near);
      }
  }
  const auto moves = [&](const Item& item) {
    return std::ranges::any_of(
        robots_, [&](const MovingRobot& m) { return is_moved_by(m.robot, item, state); });
  };
  const auto is_looked_at = [&](const Item& item) {
    return things == nullptr || std::ranges::find(*things, item) != things->end();
  };
  std::vector<Item> resting;
  for (const auto& [a, b] : checker_.pairs(start, {})) {
    const bool first = moves(a), second = moves(b);
    if (!first && !second) continue;
    if (first && second ? things != nullptr : !is_looked_at(first ? b : a)) continue;
    Pair pair;
    pair.mover = mover_of(first ? a : b, state);
    pair.margin = margin_between(world_, state, a, b);
    if (first && second) {
      pair.other = mover_of(b, state);
    } else {
      const Item& item = first ? b : a;
      pair.rest = static_cast<std::size_t>(std::ranges::find(resting, item) - resting.begin());
      if (pair.rest == resting.size()) resting.push_back(item);
      pair.room_at_rest = room_at_rest(checker_, state, item);
    }
    pairs_.push_back(pair);
  }
  for (const auto& [robot, path, around] : robots_) start.q[robot] = path->front();
  std::optional<Scratch> own;
  resting_ = checker_.places(start, resting, scratch != nullptr ? *scratch : own.emplace());
  memory_.resize(pairs_.size());
  all_.resize(pairs_.size());
  std::iota(all_.begin(), all_.end(), std::size_t{0});
}

const robot::Path& MovingPairs::path_of(const Mover& m) const {
  return *std::ranges::find(robots_, m.robot, &MovingRobot::robot)->path;
}

std::size_t MovingPairs::mover_of(const Item& item, const WorldState& state) {
  for (std::size_t i = 0; i < movers_.size(); ++i)
    if (movers_[i].item == item) return i;
  movers_.push_back(detail::mover_of(checker_, state, item));
  places_.emplace_back(world_.outer(item));
  return movers_.size() - 1;
}

double MovingPairs::speed_of(const Mover& m, const std::vector<double>& from,
                             const std::vector<double>& to) const {
  const sweep::LinkMotion motion(model_of(m).kinematics, m.link, from, to);
  return motion.moves() ? sweep::MotionBounds(motion, m.reach).derivative(1) : 0;
}

void MovingPairs::prepare(std::size_t segment, std::span<const std::size_t> pairs) {
  const auto ends_of = [&](const Mover& m) {
    const robot::Path& path = path_of(m);
    return std::pair<const std::vector<double>&, const std::vector<double>&>(
        path[segment], path[std::min(segment + 1, path.size() - 1)]);
  };
  motions_.assign(movers_.size(), std::nullopt);
  errors_.assign(movers_.size(), 0);
  std::vector<double> speed(movers_.size(), 0);
  const auto prepare_mover = [&](std::size_t i) {
    if (motions_[i]) return;
    const Mover& m = movers_[i];
    const auto [from, to] = ends_of(m);
    motions_[i].emplace(model_of(m).kinematics, m.link, from, to);
    const sweep::MotionBounds bounds(*motions_[i], m.reach);
    speed[i] = motions_[i]->moves() ? bounds.derivative(1) : 0;
    errors_[i] = error_of_motion(m, bounds, speed[i], model_of(m).base);
  };
  for (const std::size_t k : pairs) {
    Pair& pair = pairs_[k];
    prepare_mover(pair.mover);
    pair.speed = speed[pair.mover];
    if (!pair.other) continue;
    prepare_mover(*pair.other);
    const Mover &a = movers_[pair.mover], &b = movers_[*pair.other];
    if (a.robot != b.robot) {
      pair.speed = (speed[pair.mover] + speed[*pair.other]) * kUp;
      continue;
    }
    const auto [from, to] = ends_of(a);
    const std::vector<double> end = held(model_of(a).kinematics, a.link, b.link, from, to);
    pair.speed = speed_of(a, from, end) + speed_of(b, from, end);
  }
  make_room(segment);
}

/// How much nearer pairs may be than on the line of a segment.
void MovingPairs::make_room(std::size_t segment) {
  for (Pair& pair : pairs_) pair.room = pair.room_at_rest;
  // Of each robot: between these its joints bound the way of what is off. Empty: nothing is.
  std::vector<std::pair<std::vector<double>, std::vector<double>>> off;
  for (const MovingRobot& moving : robots_) {
    off.emplace_back();
    if (moving.around == nullptr || moving.around->empty()) continue;
    const robot::Path& path = *moving.path;
    off.back() =
        outward(path[segment], path[std::min(segment + 1, path.size() - 1)], *moving.around);
  }
  if (std::ranges::all_of(off, [](const auto& ends) { return ends.first.empty(); })) return;
  const auto off_of = [&](const Mover& m) -> const auto& {
    const auto robot = std::ranges::find(robots_, m.robot, &MovingRobot::robot);
    return off[static_cast<std::size_t>(robot - robots_.begin())];
  };
  std::vector<double> room;
  for (const Mover& m : movers_) {
    const auto& [base, out] = off_of(m);
    room.push_back(base.empty() ? 0 : speed_of(m, base, out) * kUp);
  }
  for (Pair& pair : pairs_) {
    pair.room = (room[pair.mover] + pair.room_at_rest) * kUp;
    if (!pair.other) continue;
    const Mover &a = movers_[pair.mover], &b = movers_[*pair.other];
    pair.room = (room[pair.mover] + room[*pair.other]) * kUp;
    const auto& [base, out] = off_of(a);
    if (a.robot != b.robot || base.empty()) continue;
    const std::vector<double> end = held(model_of(a).kinematics, a.link, b.link, base, out);
    pair.room = (speed_of(a, base, end) + speed_of(b, base, end)) * kUp;
  }
}

void MovingPairs::place(double at, const std::vector<std::size_t>& pairs) {
  placed_.assign(movers_.size(), 0);
  const auto place = [&](std::size_t m) {
    if (placed_[m] != 0) return;
    placed_[m] = 1;
    places_[m].place(model_of(movers_[m]).base * motions_[m]->at(at) * movers_[m].on_link,
                     errors_[m]);
  };
  for (const std::size_t k : pairs) {
    place(pairs_[k].mover);
    if (pairs_[k].other) place(*pairs_[k].other);
  }
}

}  // namespace kaboum::world::detail
