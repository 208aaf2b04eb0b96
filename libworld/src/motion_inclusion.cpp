// Motions that stay in a region at every instant: time is halved until what moves is in the region
// with all that it may move in a stretch.

#include <kaboum/base/error.h>
#include <kaboum/world/regions.h>

#include <algorithm>
#include <cmath>

#include "mover.h"

namespace kaboum::world {
namespace {

using collide::Inclusion;
using collide::PosedSet;

class MovingInclusion {
 public:
  MovingInclusion(const Checker& checker, const WorldState& state, const Item& item,
                  std::size_t robot, std::size_t region, const MotionOptions& options,
                  std::size_t most_pieces)
      : model_(checker.world().robots[robot]),
        options_(options),
        most_pieces_(most_pieces),
        mover_(detail::mover_of(checker, state, item)),
        moved_(checker.world().outer(item)),
        region_(detail::place_of(checker.world().regions[region])) {}

  MotionInclusion run(const robot::Path& path) {
    for (std::size_t i = 0; i == 0 || i + 1 < path.size(); ++i) {
      answer_.segment = i;
      const std::vector<double>&from = path[i], &to = path[std::min(i + 1, path.size() - 1)];
      const sweep::LinkMotion motion(model_.kinematics, mover_.link, from, to);
      const sweep::MotionBounds bounds(motion, mover_.reach);
      speed_ = motion.moves() ? bounds.derivative(1) : 0;
      error_ = detail::error_of_motion(mover_, bounds, speed_, model_.base);
      if (!stays(motion, 0, 1)) break;
    }
    return answer_;
  }

 private:
  /// Whether it is inside from `begin` to `end`; else the answer is written.
  bool stays(const sweep::LinkMotion& motion, double begin, double end) {
    const double middle = 0.5 * begin + 0.5 * end;
    const double half = std::max(middle - begin, end - middle) * kUp;
    const bool last = !(begin < middle && middle < end);
    const double slack = speed_ * half * kUp;
    if (options_.progress && answer_.intervals % 64 == 0)
      options_.progress(std::to_string(answer_.intervals) + " intervals");
    if (++answer_.intervals > options_.most_intervals) return fail(Inclusion::Undecided, begin);
    const Transform pose = model_.base * motion.at(middle) * mover_.on_link;
    const Inclusion whole = ask(pose, slack);
    if (whole == Inclusion::Included) return true;
    if (slack <= options_.resolution || last) {
      answer_.found = middle;
      return fail(whole, begin);
    }
    return stays(motion, begin, middle) && stays(motion, middle, end);
  }

  Inclusion ask(const Transform& pose, double slack) {
    moved_.place(pose, (error_ + slack) * kUp);
    return collide::find_inclusion(moved_, region_, most_pieces_);
  }

  bool fail(Inclusion answer, double begin) {
    answer_.answer = answer;
    answer_.share = begin;
    answer_.found = std::max(answer_.found, begin);
    return false;
  }

  const RobotModel& model_;
  const MotionOptions& options_;
  std::size_t most_pieces_;
  detail::Mover mover_;
  PosedSet moved_, region_;
  double speed_ = 0, error_ = 0;
  MotionInclusion answer_;
};

}  // namespace

MotionInclusion find_inclusion(const Checker& checker, const WorldState& state, std::size_t robot,
                               const robot::Path& path, const Item& item, std::size_t region,
                               const MotionOptions& options, std::size_t most_pieces) {
  detail::require_motion(checker, state, robot, path, options);
  const World& world = checker.world();
  if (region >= world.regions.size()) throw Error(ErrorCode::InvalidArgument, "no such region");
  const bool exists =
      item.robot == Item::kObject
          ? item.index < world.objects.size()
          : item.robot < world.robots.size() && item.index < world.robots[item.robot].shapes.size();
  if (!exists) throw Error(ErrorCode::InvalidArgument, "no such item");
  WorldState start = state;
  start.q[robot] = path.front();
  static_cast<void>(checker.places(start));  // throws as for states
  if (detail::is_moved_by(robot, item, state)) {
    return MovingInclusion(checker, state, item, robot, region, options, most_pieces).run(path);
  }
  MotionInclusion out;
  out.answer = find_inclusion(checker, start, item, region, most_pieces);
  return out;
}

}  // namespace kaboum::world
