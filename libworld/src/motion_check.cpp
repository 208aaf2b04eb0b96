// Motions that are free at every instant: time is halved until bodies move less than they are
// apart.

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/motion_check.h>

#include <algorithm>
#include <cmath>

#include "mover.h"

namespace kaboum::world {
namespace {

using collide::PosedSet;
using Outcome = MotionAnswer::Outcome;

using detail::Mover;

struct Pair {
  std::size_t mover = 0;             ///< number of a Mover
  std::optional<std::size_t> other;  ///< another one, else something that rests
  std::size_t rest = 0;
  double speed = 0;  ///< bound of how fast they approach each other in a segment [length]
};

class Motion {
 public:
  Motion(const Checker& checker, const WorldState& state, std::size_t robot,
         const robot::Path& path, const MotionOptions& options)
      : checker_(checker),
        world_(checker.world()),
        model_(world_.robots[robot]),
        robot_(robot),
        path_(path),
        options_(options) {
    collect(state);
  }

  MotionAnswer run() {
    for (std::size_t i = 0; i == 0 || i + 1 < path_.size(); ++i) {
      segment_ = i;
      prepare(path_[i], path_[std::min(i + 1, path_.size() - 1)]);
      std::vector<std::size_t> all(pairs_.size());
      for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
      if (!is_free(0, 1, all)) break;
    }
    // What was merely near at some middle may be found free in its parts.
    if (answer_.outcome != Outcome::Contact && !answer_.meets) answer_.contact.reset();
    return answer_;
  }

 private:
  std::size_t mover_of(const Item& item, const WorldState& state) {
    for (std::size_t i = 0; i < movers_.size(); ++i)
      if (movers_[i].item == item) return i;
    movers_.push_back(detail::mover_of(checker_, state, item));
    places_.emplace_back(world_.outer(item));
    return movers_.size() - 1;
  }

  std::size_t rest_of(const Item& item, const std::vector<Checker::Placed>& placed) {
    for (std::size_t i = 0; i < resting_.size(); ++i)
      if (resting_[i].item == item) return i;
    for (const Checker::Placed& p : placed)
      if (p.item == item) resting_.push_back(p);
    return resting_.size() - 1;
  }

  void collect(const WorldState& state) {
    WorldState start = state;
    start.q[robot_] = path_.front();
    const std::vector<Checker::Placed> placed = checker_.places(start);
    // A path that leaves the limits makes pairs count that are proved apart within them.
    for (const std::vector<double>& q : path_)
      if (!checker_.is_within_limits(robot_, q)) start.q[robot_] = q;
    for (const auto& [a, b] : checker_.pairs(start, {})) {
      const bool first = detail::is_moved_by(robot_, a, state),
                 second = detail::is_moved_by(robot_, b, state);
      if (!first && !second) continue;
      Pair pair;
      pair.mover = mover_of(first ? a : b, state);
      if (first && second)
        pair.other = mover_of(b, state);
      else
        pair.rest = rest_of(first ? b : a, placed);
      pairs_.push_back(pair);
    }
    memory_.resize(pairs_.size());
  }

  /// The links from the root to one, itself included.
  [[nodiscard]] std::vector<std::uint32_t> chain(std::uint32_t link) const {
    std::vector<std::uint32_t> out;
    for (;; link = model_.kinematics.joints[link - 1].parent) {
      out.push_back(link);
      if (link == 0) break;
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

  /// Ends of the segment with the variables held that move what both links hang from, so that only
  /// their motion relative to it counts. Unchanged where such a variable moves one of them as well.
  [[nodiscard]] std::vector<double> held(std::uint32_t a, std::uint32_t b,
                                         const std::vector<double>& from,
                                         const std::vector<double>& to) const {
    const auto x = chain(a), y = chain(b);
    std::size_t common = 0;
    while (common < x.size() && common < y.size() && x[common] == y[common]) ++common;
    const auto& joints = model_.kinematics.joints;
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

  [[nodiscard]] double speed_of(const Mover& m, const std::vector<double>& from,
                                const std::vector<double>& to) const {
    const sweep::LinkMotion motion(model_.kinematics, m.link, from, to);
    return motion.moves() ? sweep::MotionBounds(motion, m.points).derivative(1) : 0;
  }

  void prepare(const std::vector<double>& from, const std::vector<double>& to) {
    motions_.clear();
    errors_.clear();
    std::vector<double> speed;
    for (const Mover& m : movers_) {
      motions_.emplace_back(model_.kinematics, m.link, from, to);
      const sweep::MotionBounds bounds(motions_.back(), m.points);
      speed.push_back(motions_.back().moves() ? bounds.derivative(1) : 0);
      errors_.push_back(detail::error_of_motion(m, bounds, speed.back(), model_.base));
    }
    for (Pair& pair : pairs_) {
      pair.speed = speed[pair.mover];
      if (!pair.other) continue;
      const Mover &a = movers_[pair.mover], &b = movers_[*pair.other];
      const std::vector<double> end = held(a.link, b.link, from, to);
      pair.speed = speed_of(a, from, end) + speed_of(b, from, end);
    }
  }

  [[nodiscard]] std::optional<collide::BodyPair> ask(std::size_t k, double slack) {
    const Pair& pair = pairs_[k];
    ++answer_.queries;
    return find_collision(places_[pair.mover], second(pair), slack, &memory_[k]);
  }

  [[nodiscard]] const PosedSet& second(const Pair& pair) const {
    return pair.other ? places_[*pair.other] : resting_[pair.rest].place;
  }

  void place_movers(double at, const std::vector<std::size_t>& pairs) {
    placed_.assign(movers_.size(), 0);
    const auto place = [&](std::size_t m) {
      if (placed_[m] != 0) return;
      placed_[m] = 1;
      places_[m].place(model_.base * motions_[m].at(at) * movers_[m].on_link, errors_[m]);
    };
    for (const std::size_t k : pairs) {
      place(pairs_[k].mover);
      if (pairs_[k].other) place(*pairs_[k].other);
    }
  }

  /// Whether these pairs are apart from `begin` to `end`; else the answer is written.
  bool is_free(double begin, double end, const std::vector<std::size_t>& pairs) {
    if (pairs.empty()) return true;
    if (++answer_.intervals > options_.most_intervals) {
      answer_.outcome = Outcome::Undecided;
      answer_.segment = segment_;
      answer_.share = begin;
      return false;
    }
    const double middle = 0.5 * begin + 0.5 * end;
    const double half = std::max(middle - begin, end - middle) * kUp;
    place_movers(middle, pairs);
    // The last stretch: doubles hold no instant between its ends.
    const bool last = !(begin < middle && middle < end);
    std::vector<std::size_t> near;
    double farthest = 0;
    bool contact = false;
    for (const std::size_t k : pairs) {
      const double slack = pairs_[k].speed * half * kUp;
      const auto bodies = ask(k, slack);
      if (!bodies) continue;
      near.push_back(k);
      farthest = std::max(farthest, slack);
      const auto meeting = slack > 0 ? ask(k, 0) : bodies;
      if (contact || (!meeting && !last && farthest > options_.resolution)) continue;
      contact = meeting.has_value();
      note(k, meeting ? *meeting : *bodies, middle, contact);
    }
    if (near.empty()) return true;
    if (farthest <= options_.resolution || last) {
      answer_.outcome = Outcome::Contact;
      answer_.segment = segment_;
      answer_.share = begin;
      return false;
    }
    return is_free(begin, middle, near) && is_free(middle, end, near);
  }

  /// Keeps the earliest contact; one that meets rather than one that is merely near.
  void note(std::size_t k, const collide::BodyPair& bodies, double at, bool meets) {
    if (answer_.contact && answer_.meets && !meets) return;
    const Item& other =
        pairs_[k].other ? movers_[*pairs_[k].other].item : resting_[pairs_[k].rest].item;
    answer_.contact = contact_of(world_, movers_[pairs_[k].mover].item, other,
                                 places_[pairs_[k].mover], second(pairs_[k]), bodies);
    answer_.meets = meets;
    answer_.contact_segment = segment_;
    answer_.contact_share = at;
  }

  const Checker& checker_;
  const World& world_;
  const RobotModel& model_;
  std::size_t robot_;
  const robot::Path& path_;
  const MotionOptions& options_;
  std::vector<Mover> movers_;
  std::vector<PosedSet> places_;  ///< of the movers
  std::vector<char> placed_;
  std::vector<Checker::Placed> resting_;
  std::vector<Pair> pairs_;
  std::vector<collide::Memory> memory_;
  std::size_t segment_ = 0;
  std::vector<sweep::LinkMotion> motions_;
  std::vector<double> errors_;
  MotionAnswer answer_;
};

}  // namespace

void detail::require_motion(const Checker& checker, const WorldState& state, std::size_t robot,
                            const robot::Path& path, const MotionOptions& options) {
  if (robot >= checker.world().robots.size())
    throw Error(ErrorCode::InvalidArgument, "no such robot");
  if (state.q.size() != checker.world().robots.size())
    throw Error(ErrorCode::InvalidArgument, "a state of another world");
  if (!(options.resolution > 0))
    throw Error(ErrorCode::InvalidArgument, "a resolution must be above 0");
  if (path.empty()) throw Error(ErrorCode::InvalidArgument, "a path without waypoints");
  for (const std::vector<double>& q : path) {
    if (q.size() != checker.world().robots[robot].kinematics.variables.size())
      throw Error(ErrorCode::InvalidArgument, "a waypoint of another robot");
    if (!std::all_of(q.begin(), q.end(), [](double x) { return std::abs(x) <= 1e9; }))
      throw Error(ErrorCode::InvalidArgument,
                  "a waypoint with a value that is not from -1e9 to 1e9");
  }
}

MotionAnswer check_motion(const Checker& checker, const WorldState& state, std::size_t robot,
                          const robot::Path& path, const MotionOptions& options) {
  detail::require_motion(checker, state, robot, path, options);
  return Motion(checker, state, robot, path, options).run();
}

}  // namespace kaboum::world
