// Which pairs of a world collide in a state.

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>

#include "placement.h"

namespace kaboum::world {

using collide::PosedSet;

/// For the world that it was used for last.
struct Scratch::Impl {
  std::shared_ptr<const char> checker;  ///< whose items these are
  std::vector<PosedSet> places;         ///< of all items
  std::vector<char> rests;              ///< of objects: their place is that of a pose, and holds
  std::vector<collide::Memory> memory;  ///< of pairs of items, row by row
};

Scratch::Scratch() : impl_(std::make_unique<Impl>()) {}
Scratch::~Scratch() = default;
Scratch::Scratch(Scratch&&) noexcept = default;
Scratch& Scratch::operator=(Scratch&&) noexcept = default;

namespace {

/// Values that errors of kinematics are bounded for beforehand.
constexpr double kFarthest = 100;
/// Values beyond that are refused: rounding of doubles would not be small against any robot.
constexpr double kLargest = 1e9;

void require_fits(const World& world, const WorldState& state) {
  bool fits = state.q.size() == world.robots.size() && state.poses.size() == world.objects.size() &&
              state.attachments.size() == world.objects.size() &&
              (state.absent.empty() || state.absent.size() == world.objects.size());
  for (std::size_t r = 0; fits && r < world.robots.size(); ++r)
    fits = state.q[r].size() == world.robots[r].kinematics.variables.size();
  if (!fits) throw Error(ErrorCode::InvalidArgument, "a state of another world");
  for (const auto& q : state.q)
    for (const double value : q)
      if (!(std::abs(value) <= kLargest))
        throw Error(ErrorCode::InvalidArgument, "a joint value that is not from -1e9 to 1e9");
  for (std::size_t o = 0; o < state.poses.size(); ++o)
    if (!state.attachments[o] && !(state.poses[o].translation.cwiseAbs().maxCoeff() <= kLargest))
      throw Error(ErrorCode::InvalidArgument, "a position that is not from -1e9 to 1e9");
  for (const auto& a : state.attachments)
    if (a && (a->robot >= world.robots.size() ||
              a->link >= world.robots[a->robot].kinematics.links.size()))
      throw Error(ErrorCode::InvalidArgument, "an attachment to a link that does not exist");
}

/// Whether the link holds the object, or may touch what is held.
bool is_carried_by_link(const WorldState& state, const Item& object, const Item& shape,
                        const World& world) {
  const auto& attachment = state.attachments[object.index];
  if (!attachment || shape.robot != attachment->robot) return false;
  const std::uint32_t link = world.robots[shape.robot].shapes[shape.index].link;
  return link == attachment->link ||
         std::binary_search(attachment->touching.begin(), attachment->touching.end(), link);
}

/// Where two items need not be looked at, whatever is attached.
enum class Exempt { Nowhere, WithinLimits, Everywhere };

/// `proofs_hold`: of robot a, what was proved was for the robot as it is.
Exempt is_exempt(const World& world, const Item& a, const Item& b, bool proofs_hold) {
  for (const auto& [x, y] : world.allowed)
    if ((a == x && b == y) || (a == y && b == x)) return Exempt::Everywhere;
  if (a.robot == Item::kObject || a.robot != b.robot) return Exempt::Nowhere;
  const RobotModel& robot = world.robots[a.robot];
  const auto [low, high] = std::minmax(robot.shapes[a.index].link, robot.shapes[b.index].link);
  if (low == high) return Exempt::Everywhere;
  Exempt out = Exempt::Nowhere;
  for (const AllowedPair& pair : robot.allowed) {
    if (pair.a != low || pair.b != high) continue;
    // The proof of the others is for values within the limits.
    if (pair.reason != AllowedPair::Reason::Never) return Exempt::Everywhere;
    if (proofs_hold) out = Exempt::WithinLimits;
  }
  return out;
}

}  // namespace

Contact contact_of(const World& world, const Item& a, const Item& b, const PosedSet& at_a,
                   const PosedSet& at_b, const collide::BodyPair& bodies) {
  Contact out{{a, b}, bodies};
  const BoundingSet &outer_a = at_a.set(), &outer_b = at_b.set();
  out.epsilon =
      (outer_a.epsilon() + outer_b.epsilon() + at_a.error() + at_b.error()) * (1 + 0x1p-50);
  const collide::Gap gap = gap_between(at_a.body(bodies.a), at_b.body(bodies.b));
  out.place = 0.5 * (gap.on_a + gap.on_b);
  const auto inner = [&](const Item& item, const PosedSet& at) -> std::optional<PosedSet> {
    if (world.inner(item)) return PosedSet(*world.inner(item), at.pose(), at.error());
    if (at.set().epsilon() == 0) return at;
    return std::nullopt;
  };
  const auto inner_a = inner(a, at_a), inner_b = inner(b, at_b);
  out.certain = inner_a && inner_b && certainly_collide(*inner_a, *inner_b);
  return out;
}

Checker::Checker(const World& world) : world_(&world) {
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    const RobotModel& robot = world.robots[r];
    const std::size_t n = robot.kinematics.variables.size();
    std::vector<double> low(n), high(n);
    for (std::size_t i = 0; i < n; ++i) {
      const robot::Variable& variable = robot.kinematics.variables[i];
      low[i] = std::max(variable.lower.value_or(-kFarthest), -kFarthest);
      high[i] = std::max(std::min(variable.upper.value_or(kFarthest), kFarthest), low[i]);
    }
    error_.emplace_back();
    for (std::size_t s = 0; s < robot.shapes.size(); ++s) {
      const Item item{r, s};
      items_.push_back(item);
      hulls_[item] = detail::hull_points(robot.shapes[s].outer);
      radius_.push_back(detail::radius_of(robot.shapes[s].outer));
      if (hulls_[item].empty()) hulls_[item].emplace_back(Vec3::Zero());
      const sweep::LinkMotion motion(robot.kinematics, robot.shapes[s].link, low, high);
      error_.back().push_back(
          detail::placement_error(sweep::MotionBounds(motion, hulls_[item]), robot.base));
    }
    low_.push_back(std::move(low));
    high_.push_back(std::move(high));
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    const Item item{Item::kObject, o};
    items_.push_back(item);
    hulls_[item] = detail::hull_points(world.objects[o].outer);
    if (hulls_[item].empty()) hulls_[item].emplace_back(Vec3::Zero());
    radius_.push_back(detail::radius_of(world.objects[o].outer));
  }
  std::vector<char> proofs_hold;
  for (const RobotModel& robot : world.robots)
    proofs_hold.push_back(robot.fingerprint == fingerprint_of(robot) ? 1 : 0);
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const bool proved = items_[i].robot != Item::kObject && proofs_hold[items_[i].robot] != 0;
    for (std::size_t j = i + 1; j < items_.size(); ++j) {
      const Exempt exempt = is_exempt(world, items_[i], items_[j], proved);
      if (exempt == Exempt::WithinLimits) pairs_within_limits_.push_back({i, j});
      if (exempt != Exempt::Nowhere) continue;
      (items_[i].robot == Item::kObject ? object_pairs_ : robot_pairs_).push_back({i, j});
    }
  }
}

bool Checker::is_within_limits(std::size_t robot, const std::vector<double>& q) const {
  const auto& variables = world_->robots[robot].kinematics.variables;
  for (std::size_t i = 0; i < variables.size(); ++i)
    if (q[i] < variables[i].lower.value_or(q[i]) || q[i] > variables[i].upper.value_or(q[i]))
      return false;
  return true;
}

void Checker::place(const WorldState& state, Scratch& scratch) const {
  require_fits(*world_, state);
  Scratch::Impl& s = *scratch.impl_;
  if (s.checker != identity_) {
    s.places.clear();
    for (const Item& item : items_) s.places.emplace_back(world_->outer(item));
    s.memory.assign(items_.size() * items_.size(), {});
    s.rests.assign(world_->objects.size(), 0);
    s.checker = identity_;
  }
  std::vector<std::vector<Transform>> links;
  std::size_t next = 0;
  for (std::size_t r = 0; r < world_->robots.size(); ++r) {
    const RobotModel& robot = world_->robots[r];
    const std::vector<double>& q = state.q[r];
    links.push_back(forward(robot.kinematics, q));
    for (Transform& pose : links.back()) pose = robot.base * pose;
    bool usual = true;
    for (std::size_t i = 0; i < q.size(); ++i)
      usual = usual && q[i] >= low_[r][i] && q[i] <= high_[r][i];
    for (std::size_t i = 0; i < robot.shapes.size(); ++i, ++next) {
      const std::uint32_t link = robot.shapes[i].link;
      double error = error_[r][i];
      if (!usual)
        error = detail::placement_error(
            sweep::MotionBounds(sweep::LinkMotion(robot.kinematics, link, q, q),
                                hulls_.at(items_[next])),
            robot.base);
      s.places[next].place(links[r][link], error);
    }
  }
  for (std::size_t o = 0; o < world_->objects.size(); ++o, ++next) {
    const double radius = radius_[next];
    const auto& attachment = state.attachments[o];
    if (!attachment) {
      // Most objects rest from one query to the next.
      const Transform &pose = state.poses[o], &before = s.places[next].pose();
      if (s.rests[o] != 0 && pose.linear == before.linear && pose.translation == before.translation)
        continue;
      s.rests[o] = 0;  // also if placing throws
      s.places[next].place(pose, detail::rotation_error(pose, radius));
      s.rests[o] = 1;
      continue;
    }
    s.rests[o] = 0;
    const RobotModel& robot = world_->robots[attachment->robot];
    const std::vector<double>& q = state.q[attachment->robot];
    std::vector<Vec3> points;
    for (const Vec3& p : hulls_.at(items_[next])) points.emplace_back(attachment->pose * p);
    const sweep::MotionBounds bounds(sweep::LinkMotion(robot.kinematics, attachment->link, q, q),
                                     points);
    s.places[next].place(links[attachment->robot][attachment->link] * attachment->pose,
                         detail::placement_error(bounds, robot.base) +
                             detail::attachment_error(attachment->pose, radius));
  }
}

template <typename Pair>
void Checker::visit(const WorldState& state, const Options& options, const Pair& pair) const {
  const bool carries = std::any_of(state.attachments.begin(), state.attachments.end(),
                                   [](const auto& attachment) { return attachment.has_value(); });
  const auto is_absent = [&](std::size_t i) {
    return !state.absent.empty() && items_[i].robot == Item::kObject &&
           state.absent[items_[i].index];
  };
  for (const auto& [i, j] : robot_pairs_) {
    if (is_absent(j)) continue;
    if (carries && items_[j].robot == Item::kObject &&
        is_carried_by_link(state, items_[j], items_[i], *world_))
      continue;
    if (pair(i, j)) return;
  }
  for (const auto& [i, j] : pairs_within_limits_) {
    const std::size_t robot = items_[i].robot;
    if (!is_within_limits(robot, state.q[robot]) && pair(i, j)) return;
  }
  if (!carries && !options.resting) return;
  for (const auto& [i, j] : object_pairs_) {
    if (is_absent(i) || is_absent(j)) continue;
    const bool rest = !state.attachments[items_[i].index] && !state.attachments[items_[j].index];
    if (rest && !options.resting) continue;
    if (pair(i, j)) return;
  }
}

std::vector<std::array<Item, 2>> Checker::pairs(const WorldState& state,
                                                const Options& options) const {
  std::vector<std::array<Item, 2>> out;
  require_fits(*world_, state);
  visit(state, options, [&](std::size_t i, std::size_t j) {
    out.push_back({items_[i], items_[j]});
    return false;
  });
  return out;
}

std::vector<Checker::Placed> Checker::places(const WorldState& state) const {
  Scratch scratch;
  place(state, scratch);
  std::vector<Placed> out;
  for (std::size_t i = 0; i < items_.size(); ++i)
    out.push_back({items_[i], scratch.impl_->places[i]});
  return out;
}

template <typename Found>
void Checker::visit_contacts(const WorldState& state, Scratch& scratch, const Options& options,
                             const Found& found) const {
  place(state, scratch);
  Scratch::Impl& s = *scratch.impl_;
  visit(state, options, [&](std::size_t i, std::size_t j) {
    const auto bodies =
        find_collision(s.places[i], s.places[j], 0, &s.memory[i * items_.size() + j]);
    return bodies &&
           found(contact_of(*world_, items_[i], items_[j], s.places[i], s.places[j], *bodies));
  });
}

std::optional<Contact> Checker::find_contact(const WorldState& state, Scratch& scratch,
                                             const Options& options) const {
  std::optional<Contact> out;
  visit_contacts(state, scratch, options, [&](Contact contact) {
    out = std::move(contact);
    return true;
  });
  return out;
}

std::vector<Contact> Checker::find_contacts(const WorldState& state, Scratch& scratch,
                                            const Options& options) const {
  std::vector<Contact> out;
  visit_contacts(state, scratch, options, [&](Contact contact) {
    out.push_back(std::move(contact));
    return false;
  });
  return out;
}

std::optional<Checker::Nearest> Checker::find_nearest(const WorldState& state, Scratch& scratch,
                                                      const Options& options) const {
  place(state, scratch);
  Scratch::Impl& s = *scratch.impl_;
  std::optional<Nearest> best;
  double lower = 0;
  visit(state, options, [&](std::size_t i, std::size_t j) {
    const auto distance = clearance(s.places[i], s.places[j]);
    if (!distance) return false;
    lower = best ? std::min(lower, distance->lower) : distance->lower;
    if (!best || distance->upper < best->clearance.upper)
      best = {{items_[i], items_[j]}, *distance};
    return false;
  });
  if (best) best->clearance.lower = lower;
  return best;
}

}  // namespace kaboum::world
