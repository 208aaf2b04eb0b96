// Configurations of a robot as a search sees them, and the count of what it does.

#include "search_space.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/path.h>
#include <kaboum/sweep/motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaboum::motion {
namespace {

using Outcome = PathAnswer::Outcome;

// Steps in about seconds of one core; only their ratio matters to what is found.
constexpr double kConfiguration = 4e-6, kMotion = 20e-6, kInterval = 5e-6, kNode = 10e-9,
                 kInstant = 0.5e-6, kProjection = 35e-6, kPack = 1e-6, kStretch = 0.15e-6,
                 kSample = 0.2e-6;

/// A configuration is on the constraints where no deviation is more than this part of what is
/// allowed: the rest is for the lines between such configurations.
constexpr double kOnConstraint = 0.1;
/// A way is halved so often, until its stretches keep the constraints.
constexpr int kMostHalvings = 10;
/// A point between, projected, is not farther from either end than this part of their distance.
constexpr double kLongestHalf = 0.8;

constexpr std::size_t kMostBlockers = 5;
constexpr std::size_t kToldEvery = 64;  // configurations

/// A variable that moves the robot little is not to be free of cost.
constexpr double kLeastWeight = 0.1;
/// Configurations of motions that are only looked at are so near each other, in parts of a step.
constexpr double kSpacing = 0.05;
/// Motions that were not free and may be asked for what is in the way: so many, then some.
constexpr std::size_t kFewBlocked = 32;
/// Configurations of a motion that are looked at where vector code leaves it open.
constexpr std::size_t kMostLooks = 16;

}  // namespace

void require_fits(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                  const Values& q) {
  const std::vector<world::RobotModel>& robots = checker.world().robots;
  if (robot >= robots.size()) throw Error(ErrorCode::InvalidArgument, "no such robot");
  if (state.q.size() != robots.size() ||
      state.attachments.size() != checker.world().objects.size() ||
      state.poses.size() != checker.world().objects.size())
    throw Error(ErrorCode::InvalidArgument, "a state of another world");
  if (q.size() != robots[robot].kinematics.variables.size())
    throw Error(ErrorCode::InvalidArgument, "a configuration of another robot");
  if (!std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); }))
    throw Error(ErrorCode::InvalidArgument, "a configuration with a value that is not finite");
}

Values between(const Values& a, const Values& b, double share) {
  Values out = a;
  // Between them, whatever is rounded: limits are kept.
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::clamp(a[i] + share * (b[i] - a[i]), std::min(a[i], b[i]), std::max(a[i], b[i]));
  return out;
}

Metric metric_of(const world::Checker& checker, const world::WorldState& state, std::size_t robot) {
  const world::RobotModel& model = checker.world().robots[robot];
  const std::size_t count = model.kinematics.variables.size();
  Metric out;
  out.weight.assign(count, 0);
  const auto weigh = [&](std::uint32_t link, const sweep::Reach& reach) {
    for (std::size_t i = 0; i < count; ++i) {
      Values to = model.home;
      to[i] += 1;
      const sweep::LinkMotion motion(model.kinematics, link, model.home, to);
      if (motion.moves())
        out.weight[i] = std::max(out.weight[i], sweep::MotionBounds(motion, reach).derivative(1));
    }
  };
  for (std::size_t i = 0; i < model.shapes.size(); ++i)
    weigh(model.shapes[i].link, checker.reach_of(robot, i));
  for (std::size_t o = 0; o < state.attachments.size(); ++o) {
    const auto& attachment = state.attachments[o];
    if (!attachment || attachment->robot != robot) continue;
    std::vector<geom::Vec3> points = checker.hull_of({world::Item::kObject, o});
    for (geom::Vec3& p : points) p = attachment->pose * p;
    weigh(attachment->link, sweep::reach_of(sweep::LinkMotion(model.kinematics, attachment->link,
                                                              model.home, model.home),
                                            points));
  }
  double most = 0;
  for (const double w : out.weight) most = std::max(most, w);
  if (!(most > 0)) most = 1;
  for (double& w : out.weight) w = std::max(w, kLeastWeight * most);
  out.range = most;
  return out;
}

SearchSpace::SearchSpace(const world::Checker& checker, world::WorldState state, std::size_t robot,
                         const Values& start, const PathOptions& options, const Metric& metric,
                         SearchMemory& memory)
    : checker_(checker),
      state_(std::move(state)),
      robot_(robot),
      options_(options),
      metric_(metric),
      memory_(memory),
      scratch_(options.check.scratch != nullptr ? *options.check.scratch : memory.scratch),
      bands_(bands_of(options.constraints, checker.world().robots[robot], start)),
      projection_(checker.world().robots[robot], options.constraints, bands_) {
  kept_.parts.resize(options.constraints.size());
  check_.where = false;
  check_.scratch = &scratch_;
  memory_.decided.clear();
}

void SearchSpace::draw_around(const Values& start, std::span<const Values> goals) {
  const robot::Robot& robot = kinematics();
  lower_ = upper_ = near_lower_ = near_upper_ = start;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const robot::Variable& v = robot.variables[i];
    double low = start[i], high = start[i];
    for (const Values& goal : goals) {
      low = std::min(low, goal[i]);
      high = std::max(high, goal[i]);
    }
    // Joints that move along and have no limits go as far again as they have to, and a bit.
    const bool turns = robot::is_angle(robot, v);
    const double more = turns ? std::numbers::pi : high - low + 1;
    lower_[i] = v.lower.value_or(low - more);
    upper_[i] = v.upper.value_or(high + more);
    near_lower_[i] = turns ? std::max(lower_[i], low - more) : lower_[i];
    near_upper_[i] = turns ? std::min(upper_[i], high + more) : upper_[i];
  }
  for (const std::uint32_t i : options_.still)
    lower_[i] = upper_[i] = near_lower_[i] = near_upper_[i] = start[i];
}

Values SearchSpace::sample(Random& random) {
  const bool anywhere = random.index(8) == 0;
  const Values &low = anywhere ? lower_ : near_lower_, &high = anywhere ? upper_ : near_upper_;
  Values q(low.size());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = random.between(low[i], high[i]);
  ++spent_.samples;
  spent_.work += kSample;
  return q;
}

double SearchSpace::distance(const Values& a, const Values& b) const {
  return std::sqrt(squared_distance(a.data(), b.data()));
}

double SearchSpace::squared_distance(const double* a, const double* b) const {
  double sum = 0;
  for (std::size_t i = 0; i < metric_.weight.size(); ++i) {
    const double d = metric_.weight[i] * (b[i] - a[i]);
    sum += d * d;
  }
  return sum;
}

void SearchSpace::tell(std::size_t count) const {
  if (count % kToldEvery != 0 || !options_.check.progress) return;
  options_.check.progress((decides_motions()
                               ? std::to_string(spent_.motions) + " motions, "
                               : std::to_string(spent_.configurations) + " configurations, ") +
                          std::to_string(spent_.nodes) + " nodes");
}

std::optional<world::Contact> SearchSpace::find_contact(const Values& q) {
  tell(spent_.configurations++);
  spent_.work += kConfiguration;
  state_.q[robot_] = q;
  std::optional<world::Contact> contact = checker_.find_contact(state_, scratch_);
  note(contact);
  return contact;
}

Known SearchSpace::look(const Values& from, const Values& to, bool closely) {
  using Answer = filter::MotionChecker::Answer;
  Known* known = memory_.decided.find(from, to);
  if (known == nullptr) {
    const Answer answer = filter(from, to);
    tell(spent_.motions++);
    memory_.decided.add(from, to,
                        answer == Answer::Free      ? Known::Free
                        : answer == Answer::Contact ? Known::NotFree
                                                    : Known::Open);
    known = memory_.decided.find(from, to);
    if (answer == Answer::Contact) note_blocked(from, to);
  } else if (closely && *known == Known::Open) {
    filter(from, to);  // which has the open stretches of the last motion
  }
  if (closely && *known == Known::Open) {
    *known = looks_free_where_open(from, to) ? Known::LooksFree : Known::NotFree;
    if (*known == Known::NotFree) note_blocked(from, to);
  }
  return *known;
}

void SearchSpace::note_blocked(const Values& from, const Values& to) {
  // The first ones, then fewer and fewer.
  const std::size_t n = blocked_count_++;
  if (n < kFewBlocked || (n & (n - 1)) == 0) blocked_.push_back({from, to});
}

filter::MotionChecker::Answer SearchSpace::filter(const Values& from, const Values& to) {
  filter::MotionChecker& motions = *memory_.motions;
  const std::size_t before = motions.stretches();
  const auto answer = motions.filter(from, to, check_.resolution);
  const std::size_t stretches = motions.stretches() - before;
  spent_.intervals += stretches;
  spent_.work += kPack + kStretch * static_cast<double>(stretches);
  return answer;
}

bool SearchSpace::is_soon_certain(const Values& from, const Values& to) {
  if (decides_motions()) return look(from, to, false) == Known::Free;
  return looks_free(from, to) && check({from, to}).outcome == world::MotionAnswer::Outcome::Free;
}

bool SearchSpace::is_certain(const Values& from, const Values& to) {
  const Known known = look(from, to, true);
  if (known != Known::LooksFree) return known == Known::Free;
  using Answer = filter::MotionChecker::Answer;
  bool free = filter(from, to) == Answer::Free;  // it is open, and now the last one
  if (!free && memory_.motions->open().empty()) {
    free = check_exactly({from, to}).outcome == world::MotionAnswer::Outcome::Free;
  } else if (!free) {
    std::size_t intervals = 0;
    free = memory_.motions->are_open_free(from, to, check_, intervals);
    spent_.intervals += intervals;
    spent_.work += kMotion + kInterval * static_cast<double>(intervals);
  }
  *memory_.decided.find(from, to) = free ? Known::Free : Known::NotFree;
  return free;
}

bool SearchSpace::looks_free_where_open(const Values& from, const Values& to) {
  const auto open = memory_.motions->open();
  if (open.empty()) return looks_free_at_places(from, to);
  std::size_t most = 2;
  while (most <= open.size()) most *= 2;
  std::size_t looks = 0;
  // Far apart first: the middle one, then those at quarters, and so on.
  for (std::size_t step = most; step > 1; step /= 2)
    for (std::size_t at = step / 2; at <= open.size(); at += step) {
      if (looks++ == kMostLooks) return true;
      ++spent_.configurations;
      spent_.work += kConfiguration;
      state_.q[robot_] = between(from, to, 0.5 * (open[at - 1][0] + open[at - 1][1]));
      const auto pairs = memory_.motions->open_pairs();
      if (pairs.empty() ? !checker_.is_free(state_, scratch_)
                        : !checker_.are_apart(state_, pairs, scratch_))
        return false;
    }
  return true;
}

bool SearchSpace::looks_free(const Values& from, const Values& to) {
  if (decides_motions()) return look(from, to, true) != Known::NotFree;
  return looks_free_at_places(from, to);
}

bool SearchSpace::looks_free_at_places(const Values& from, const Values& to) {
  if (find_contact(to)) return false;
  const auto parts = static_cast<std::size_t>(std::ceil(distance(from, to) / (kSpacing * range())));
  // Far apart first: halves, then quarters between them, and so on.
  std::size_t most = 1;
  while (most < parts) most *= 2;
  for (std::size_t step = most; step > 1; step /= 2)
    for (std::size_t at = step / 2; at < most; at += step)
      if (find_contact(between(from, to, static_cast<double>(at) / static_cast<double>(most))))
        return false;
  return true;
}

bool SearchSpace::project(Values& q) {
  spent_.work += kProjection;
  return projection_.project(q, kOnConstraint);
}

bool SearchSpace::keeps(const Values& from, const Values& to) {
  kept_.instants = 0;
  const bool kept = check_segment(kinematic_model(), bands_, from, to, check_, kept_);
  spent_.work += kInstant * static_cast<double>(kept_.instants);
  return kept;
}

std::optional<ConstraintAnswer> SearchSpace::find_broken(const robot::Path& path) {
  if (bands_.empty()) return std::nullopt;
  kept_ = check_bands(kinematic_model(), bands_, options_.constraints.size(), path, check_);
  spent_.work += kInstant * static_cast<double>(kept_.instants);
  return kept_.outcome == ConstraintAnswer::Outcome::Kept ? std::nullopt : std::optional(kept_);
}

std::optional<robot::Path> SearchSpace::way(const Values& from, const Values& to, bool back) {
  robot::Path out;
  if (!has_constraints()) {
    out.push_back(to);
  } else if (!trace(from, to, kMostHalvings, out)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Values& before = i == 0 ? from : out[i - 1];
    if (!(back && decides_motions() ? looks_free(out[i], before) : looks_free(before, out[i])))
      return std::nullopt;
  }
  return out;
}

bool SearchSpace::trace(const Values& from, const Values& to, int depth, robot::Path& out) {
  if (keeps(from, to)) {
    out.push_back(to);
    return true;
  }
  if (depth == 0) return false;
  Values middle = between(from, to, 0.5);
  if (!project(middle)) return false;
  const double most = kLongestHalf * distance(from, to);
  if (distance(from, middle) > most || distance(middle, to) > most) return false;
  return trace(from, middle, depth - 1, out) && trace(middle, to, depth - 1, out);
}

world::MotionAnswer SearchSpace::check(const robot::Path& path) {
  if (!decides_motions() || path.size() < 2) return check_exactly(path);
  world::MotionAnswer answer;
  for (; answer.segment + 1 < path.size(); ++answer.segment)
    if (!is_certain(path[answer.segment], path[answer.segment + 1])) {
      answer.outcome = world::MotionAnswer::Outcome::Contact;
      break;
    }
  return answer;
}

world::MotionAnswer SearchSpace::check_exactly(const robot::Path& path) {
  world::MotionAnswer answer = check_motion(checker_, state_, robot_, path, check_);
  const std::size_t segments = std::min(answer.segment + 1, path.size());
  spent_.motions += segments;
  spent_.intervals += answer.intervals;
  spent_.work +=
      kMotion * static_cast<double>(segments) + kInterval * static_cast<double>(answer.intervals);
  note(answer.contact);
  return answer;
}

std::optional<Outcome> SearchSpace::ended() const {
  if (work_ended()) return Outcome::WorkEnded;
  if (spent_.nodes >= options_.most_nodes) return Outcome::NodesEnded;
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start_;
  if (time.count() >= options_.most_seconds) return Outcome::TimeEnded;
  return std::nullopt;
}

void SearchSpace::count_nodes(std::size_t looked_at) {
  spent_.work += kNode * static_cast<double>(looked_at);
}

void SearchSpace::note(const std::optional<world::Contact>& contact) {
  if (contact) ++met_[contact->items];
}

std::vector<Blocker> SearchSpace::blockers(bool found) {
  if (!found)
    for (const robot::Path& motion : blocked_)
      note(check_motion(checker_, state_, robot_, motion, check_).contact);
  std::vector<Blocker> out;
  for (const auto& [items, times] : met_) out.push_back({items, times});
  std::stable_sort(out.begin(), out.end(),
                   [](const Blocker& a, const Blocker& b) { return a.times > b.times; });
  if (out.size() > kMostBlockers) out.resize(kMostBlockers);
  return out;
}

const world::RobotModel& SearchSpace::kinematic_model() const {
  return checker_.world().robots[robot_];
}

const robot::Robot& SearchSpace::kinematics() const { return kinematic_model().kinematics; }

}  // namespace kaboum::motion
