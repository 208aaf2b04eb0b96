// Stretches of straight motions, decided where others have decided the rest: halved as in
// check_motion, but for what is decided.

#include <kaboum/base/error.h>
#include <kaboum/world/stretch_check.h>

#include <algorithm>

#include "moving_pairs.h"

namespace kaboum::world {
namespace {

/// Parts of a motion that all pairs are looked at in; smaller ones are only of pairs that are near.
constexpr double kWhole = 1.0 / 16;

}  // namespace

struct StretchChecker::Impl {
  Impl(const Checker& checker, const WorldState& state, std::size_t robot)
      : motion{checker.world().robots[robot].home, checker.world().robots[robot].home},
        moving(checker, state, {{robot, &motion}}, nullptr) {}

  /// Numbers of pairs of things. @throws Error{InvalidArgument} for one that is not looked at.
  std::vector<std::size_t> numbers_of(std::span<const std::array<Item, 2>> some) const {
    std::vector<std::size_t> out;
    for (const auto& pair : some) {
      const Item &a = pair[0], &b = pair[1];
      const auto found = std::ranges::find_if(moving.all(), [&](std::size_t k) {
        const Item &x = moving.mover(moving.pairs()[k]), &y = moving.other(moving.pairs()[k]);
        return (x == a && y == b) || (x == b && y == a);
      });
      if (found == moving.all().end())
        throw Error(ErrorCode::InvalidArgument, "a pair that is not looked at");
      out.push_back(*found);
    }
    return out;
  }

  robot::Path motion;  ///< that `moving` refers to
  detail::MovingPairs moving;
  std::span<const std::array<double, 2>> stretches;
  double distance = 0;
  std::size_t most = 0;
  Answer answer;

  /// True if no stretch has more than an end in common with this part.
  [[nodiscard]] bool is_decided(double begin, double end) const {
    const auto first =
        std::ranges::upper_bound(stretches, begin, {}, [](const auto& s) { return s[1]; });
    return first == stretches.end() || (*first)[0] >= end;
  }

  bool are_apart(double begin, double end, const std::vector<std::size_t>& pairs) {
    if (is_decided(begin, end)) return true;
    if (++answer.intervals > most) return false;
    const double middle = 0.5 * begin + 0.5 * end;
    const double half = std::max(middle - begin, end - middle) * kUp;
    moving.place(middle, pairs);
    const bool last = !(begin < middle && middle < end);
    std::vector<std::size_t> near;
    for (const std::size_t k : pairs) {
      const double slack = moving.pairs()[k].speed * half * kUp;
      if (!moving.ask(k, (slack + distance) * kUp)) continue;
      if (slack <= distance || last || moving.ask(k, distance)) return false;
      near.push_back(k);
    }
    return near.empty() || (are_apart(begin, middle, near) && are_apart(middle, end, near));
  }
};

StretchChecker::StretchChecker(const Checker& checker, const WorldState& state, std::size_t robot) {
  if (robot >= checker.world().robots.size())
    throw Error(ErrorCode::InvalidArgument, "no such robot");
  if (checker.substitute() != nullptr)
    throw Error(ErrorCode::InvalidArgument, "a substitute decides no stretches");
  impl_ = std::make_unique<Impl>(checker, state, robot);
}
StretchChecker::~StretchChecker() = default;
StretchChecker::StretchChecker(StretchChecker&&) noexcept = default;
StretchChecker& StretchChecker::operator=(StretchChecker&&) noexcept = default;

StretchChecker::Answer StretchChecker::is_apart(std::span<const double> from,
                                                std::span<const double> to,
                                                std::span<const std::array<double, 2>> stretches,
                                                double distance, std::size_t most_intervals,
                                                std::span<const std::array<Item, 2>> pairs) {
  Impl& s = *impl_;
  if (from.size() != s.motion[0].size() || to.size() != s.motion[0].size())
    throw Error(ErrorCode::InvalidArgument, "a configuration of another robot");
  if (!(distance > 0)) throw Error(ErrorCode::InvalidArgument, "a distance must be above 0");
  s.motion[0].assign(from.begin(), from.end());
  s.motion[1].assign(to.begin(), to.end());
  s.stretches = stretches;
  s.distance = distance;
  s.most = most_intervals;
  s.answer = {};
  const std::vector<std::size_t> some = pairs.empty() ? s.moving.all() : s.numbers_of(pairs);
  s.moving.prepare(0, some);
  s.answer.apart = true;
  for (double begin = 0; begin < 1 && s.answer.apart; begin += kWhole)
    s.answer.apart = s.are_apart(begin, begin + kWhole, some);
  return s.answer;
}

}  // namespace kaboum::world
