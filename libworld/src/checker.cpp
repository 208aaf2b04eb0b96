// Which pairs of a world collide in a state.

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/margins.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "link_poses.h"
#include "placement.h"
#include "state_places.h"

namespace kaboum::world {

using collide::PosedSet;
using detail::PairRow;

namespace {

/// Values that errors of kinematics are bounded for beforehand.
constexpr double kFarthest = 100;
constexpr auto kAllNear = [](std::size_t) -> const std::uint64_t* { return nullptr; };

/// Whether the link holds the object, or may touch what is held.
bool is_carried_by_link(const WorldState& state, const Item& object, const Item& shape,
                        const World& world) {
  const auto& attachment = state.attachments[object.index];
  if (!attachment || shape.robot != attachment->robot) return false;
  const std::uint32_t link = world.robots[shape.robot].shapes[shape.index].link;
  return (attachment->link_touches && link == attachment->link) ||
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

/// Of `count` items, that j is one that i may collide with. @pre i < j, and i not below those
/// before
void add(std::vector<PairRow>& rows, std::size_t i, std::size_t j, std::size_t count) {
  if (rows.empty() || rows.back().item != i)
    rows.push_back({i, std::vector<std::uint64_t>((count + 63) / 64)});
  rows.back().others[j / 64] |= std::uint64_t{1} << (j % 64);
}

/// Calls pair(i, j) until it is true; not for pairs of which skip(i, j) is.
template <typename Skip, typename Look, typename Pair>
bool visit_rows(const std::vector<PairRow>& rows, const Skip& skip, const Look& look,
                const Pair& pair) {
  for (const auto& [item, others] : rows) {
    const std::uint64_t* near = look(item);
    for (std::size_t word = (item + 1) / 64; word < others.size(); ++word) {
      std::uint64_t left = others[word];
      if (near != nullptr) left &= near[word];
      for (; left != 0; left &= left - 1) {
        const std::size_t j = 64 * word + static_cast<std::size_t>(std::countr_zero(left));
        if (!skip(item, j) && pair(item, j)) return true;
      }
    }
  }
  return false;
}

}  // namespace

Contact contact_of(const World& world, const Item& a, const Item& b, const PosedSet& at_a,
                   const PosedSet& at_b, const collide::BodyPair& bodies, double margin) {
  Contact out{{a, b}, bodies};
  out.margin = margin;
  const BoundingSet &outer_a = at_a.set(), &outer_b = at_b.set();
  out.epsilon = (outer_a.epsilon() + outer_b.epsilon() + at_a.error() + at_b.error() + margin) *
                (1 + 0x1p-50);
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

Contact substituted_contact(const std::array<Item, 2>& pair) {
  Contact out{.items = pair, .bodies = {}};
  out.substituted = true;
  return out;
}

Checker::Checker(const World& world, Observer* observer, Substitute* substitute)
    : world_(&world),
      observer_(observer),
      substitute_(substitute),
      largest_margin_(world.margins.largest() * (1 + 0x1p-50)) {
  if (!(largest_margin_ >= 0 && std::isfinite(largest_margin_)))
    throw Error(ErrorCode::InvalidArgument, "a margin that is no number from 0 on");
  if (substitute != nullptr && largest_margin_ > 0)
    throw Error(ErrorCode::InvalidArgument,
                "«margin»: margins are kept by the bounded predicates only, not by «engine»");
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
    reaches_.emplace_back();
    for (std::size_t s = 0; s < robot.shapes.size(); ++s) {
      const Item item{r, s};
      items_.push_back(item);
      hulls_[item] = detail::hull_points(robot.shapes[s].outer);
      radius_.push_back(detail::radius_of(robot.shapes[s].outer));
      if (hulls_[item].empty()) hulls_[item].emplace_back(Vec3::Zero());
      const sweep::LinkMotion motion(robot.kinematics, robot.shapes[s].link, low, high);
      reaches_.back().push_back(sweep::reach_of(motion, hulls_[item]));
      error_.back().push_back(
          detail::placement_error(sweep::MotionBounds(motion, reaches_.back().back()), robot.base));
    }
    low_.push_back(std::move(low));
    high_.push_back(std::move(high));
    kinematics_.push_back(std::make_shared<detail::LinkPoses>(robot.kinematics, robot.base));
    defects_.push_back(detail::defect_of(robot, *kinematics_.back()));
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
      // What was proved is that they never meet, not that they are any distance apart.
      const auto margin = world.margins.between.find({items_[i], items_[j]});
      const bool kept_apart = margin != world.margins.between.end() && margin->second > 0;
      const Exempt exempt = is_exempt(world, items_[i], items_[j], proved && !kept_apart);
      if (exempt == Exempt::WithinLimits) add(rows_within_limits_, i, j, items_.size());
      if (exempt != Exempt::Nowhere) continue;
      add(items_[i].robot == Item::kObject ? object_rows_ : robot_rows_, i, j, items_.size());
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

template <typename Look, typename Pair>
void Checker::visit(const WorldState& state, const Options& options, const Look& look,
                    const Pair& pair) const {
  const bool carries = std::any_of(state.attachments.begin(), state.attachments.end(),
                                   [](const auto& attachment) { return attachment.has_value(); });
  const auto is_absent = [&](std::size_t i) {
    const auto& [robot, index] = items_[i];
    if (robot == Item::kObject) return !state.absent.empty() && state.absent[index];
    return !state.absent_robots.empty() && state.absent_robots[robot];
  };
  const auto skip = [&](std::size_t i, std::size_t j) {
    return is_absent(i) || is_absent(j) ||
           (carries && items_[j].robot == Item::kObject &&
            is_carried_by_link(state, items_[j], items_[i], *world_));
  };
  if (visit_rows(robot_rows_, skip, look, pair)) return;
  const auto skip_within_limits = [&](std::size_t i, std::size_t /*j*/) {
    return is_absent(i) || is_within_limits(items_[i].robot, state.q[items_[i].robot]);
  };
  if (visit_rows(rows_within_limits_, skip_within_limits, look, pair)) return;
  if (!carries && !options.resting) return;
  const auto skip_objects = [&](std::size_t i, std::size_t j) {
    const bool rest = !state.attachments[items_[i].index] && !state.attachments[items_[j].index];
    return is_absent(i) || is_absent(j) || (rest && !options.resting);
  };
  visit_rows(object_rows_, skip_objects, look, pair);
}

std::vector<std::array<Item, 2>> Checker::pairs(const WorldState& state,
                                                const Options& options) const {
  std::vector<std::array<Item, 2>> out;
  detail::require_fits(*world_, state);
  visit(state, options, kAllNear, [&](std::size_t i, std::size_t j) {
    out.push_back({items_[i], items_[j]});
    return false;
  });
  return out;
}

double Checker::margin_of(const WorldState& state, std::size_t i, std::size_t j) const {
  return largest_margin_ > 0 ? margin_between(*world_, state, items_[i], items_[j]) : 0;
}

std::optional<collide::BodyPair> Checker::find_bodies(std::size_t i, std::size_t j, double margin,
                                                      Scratch::Impl& s) const {
  if (s.is_beside_box(i, j) || s.is_beside_box(j, i)) return std::nullopt;
  if (s.memory.empty()) s.memory.resize(items_.size() * items_.size());
  return find_collision(s.set(i), s.set(j), margin, &s.memory[i * items_.size() + j]);
}

template <typename Found>
void Checker::visit_meeting(const WorldState& state, Scratch& scratch, const Options& options,
                            const Found& found) const {
  if (observer_ != nullptr) observer_->asked(state);
  place(state, scratch);
  Scratch::Impl& s = *scratch.impl_;
  const auto look = [&](std::size_t i) { return s.balls.look_from(i); };
  visit(state, options, look, [&](std::size_t i, std::size_t j) {
    const double margin = margin_of(state, i, j);
    const auto bodies = find_bodies(i, j, margin, s);
    return bodies && found(i, j, *bodies, margin);
  });
}

template <typename Found>
void Checker::visit_contacts(const WorldState& state, Scratch& scratch, const Options& options,
                             const Found& found) const {
  Scratch::Impl& s = *scratch.impl_;
  visit_meeting(
      state, scratch, options,
      [&](std::size_t i, std::size_t j, const collide::BodyPair& bodies, double margin) {
        return found(contact_of(*world_, items_[i], items_[j], s.set(i), s.set(j), bodies, margin));
      });
}

std::vector<Contact> Checker::substituted(const WorldState& state, const Options& options,
                                          bool all) const {
  if (observer_ != nullptr) observer_->asked(state);
  const std::vector<std::array<Item, 2>> looked_at = pairs(state, options);
  std::vector<Contact> out;
  for (const std::size_t k : substitute_->find_meeting(state, looked_at, all))
    out.push_back(substituted_contact(looked_at[k]));
  return out;
}

bool Checker::is_free(const WorldState& state, Scratch& scratch, const Options& options) const {
  if (substitute_ != nullptr) return substituted(state, options, false).empty();
  bool meet = false;
  visit_meeting(state, scratch, options, [&](auto&&...) { return meet = true; });
  return !meet;
}

bool Checker::are_apart(const WorldState& state, std::span<const std::array<Item, 2>> pairs,
                        Scratch& scratch) const {
  if (observer_ != nullptr) observer_->asked(state);
  place(state, scratch);
  Scratch::Impl& s = *scratch.impl_;
  const auto number_of = [&](const Item& item) {
    return static_cast<std::size_t>(std::lower_bound(items_.begin(), items_.end(), item) -
                                    items_.begin());
  };
  return std::ranges::none_of(pairs, [&](const std::array<Item, 2>& pair) {
    std::size_t i = number_of(pair[0]), j = number_of(pair[1]);
    if (i > j) std::swap(i, j);
    return find_bodies(i, j, margin_of(state, i, j), s).has_value();
  });
}

std::optional<Contact> Checker::find_contact(const WorldState& state, Scratch& scratch,
                                             const Options& options) const {
  if (substitute_ != nullptr) {
    std::vector<Contact> found = substituted(state, options, false);
    return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
  }
  std::optional<Contact> out;
  visit_contacts(state, scratch, options, [&](Contact contact) {
    out = std::move(contact);
    return true;
  });
  return out;
}

std::vector<Contact> Checker::find_contacts(const WorldState& state, Scratch& scratch,
                                            const Options& options) const {
  if (substitute_ != nullptr) return substituted(state, options, true);
  std::vector<Contact> out;
  visit_contacts(state, scratch, options, [&](Contact contact) {
    out.push_back(std::move(contact));
    return false;
  });
  return out;
}

void Checker::measure_depth(Contact& contact, const WorldState& state, Scratch& scratch) const {
  const std::vector<PosedItem> at = places(state, {contact.items[0], contact.items[1]}, scratch);
  const auto found = collide::penetration(at[0].place, at[1].place);
  if (found) contact.depth = found->depth;
}

std::optional<Checker::Nearest> Checker::find_nearest(const WorldState& state, Scratch& scratch,
                                                      const Options& options) const {
  place(state, scratch);
  Scratch::Impl& s = *scratch.impl_;
  std::optional<Nearest> best;
  double lower = 0;
  visit(state, options, kAllNear, [&](std::size_t i, std::size_t j) {
    if (options.progress) options.progress();
    auto distance = clearance(s.set(i), s.set(j));
    if (!distance) return false;
    if (distance->lower == 0) {
      if (const auto found = collide::penetration(s.set(i), s.set(j))) {
        distance->lower = -found->depth.upper;
        if (found->depth.lower > 0) {
          distance->upper = -found->depth.lower;
          distance->bodies = found->bodies;
        }
      }
    }
    lower = best ? std::min(lower, distance->lower) : distance->lower;
    if (!best || distance->upper < best->clearance.upper)
      best = {{items_[i], items_[j]}, *distance};
    return false;
  });
  if (best) best->clearance.lower = lower;
  return best;
}

}  // namespace kaboum::world
