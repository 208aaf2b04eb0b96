// Branch and bound over the joints between two links. docs/algorithms/pairs.md.

#include "search.h"

#include <kaboum/base/radical_inverse.h>
#include <kaboum/base/random.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "numbers.h"

namespace kaboum::pairs::detail {
namespace {

constexpr std::array<std::uint32_t, 16> kPrimes{2,  3,  5,  7,  11, 13, 17, 19,
                                                23, 29, 31, 37, 41, 43, 47, 53};
constexpr std::size_t kFirstSamples = 50;
constexpr std::size_t kClimbs = 4;         ///< from the best places of each time
constexpr std::size_t kTargets = 8;        ///< of each time, by twos from the best places
constexpr std::size_t kFewSteps = 400;     ///< down the trees, until a contact is seen
constexpr std::size_t kManySteps = 4'000;  ///< the same, where it matters more
constexpr std::size_t kMostSteps = 1'000;  ///< of a search for the nearest triangles
constexpr std::size_t kAlwaysBoxes = 3'000;
constexpr std::size_t kPlaces = 17;  ///< at which it is asked what one solid holds of the other
constexpr std::size_t kFewItems = 60, kMostItems = 6'000;
constexpr std::size_t kMostFixedItems = 300'000;  ///< of links that fixed joints connect

}  // namespace

Search::Search(const robot::Robot& robot, std::uint32_t a, std::uint32_t b, const Shapes& of_a,
               const Shapes& of_b, std::size_t samples)
    : chain_(robot, a, b),
      outer_(*of_a.outer, *of_b.outer, chain_),
      inner_(of_a.inner(), of_b.inner(), chain_),
      shows_(of_a.shows && of_b.shows),
      loose_(of_a.loose || of_b.loose),
      same_(shows_ && !of_a.inner_or_none && !of_b.inner_or_none),
      samples_(samples),
      tree_a_(&of_a.outer->tree()),
      tree_b_(&of_b.outer->tree()),
      motion_(chain_),
      most_items_(kMostItems) {
  if (!chain_.limits() || chain_.joints().size() > BoxMotion::Linear::kMost) {
    exhausted_ = searched_ = true;  // joints without limits that do not turn
    return;
  }
  const auto& [low, high] = *chain_.limits();
  for (std::size_t v = 0; v < low.size(); ++v) {
    middle_.push_back(0.5 * low[v] + 0.5 * high[v]);
    half_.push_back(std::max(high[v] - middle_[v], middle_[v] - low[v]) * (1 + 0x1p-40));
  }
  shows_ = shows_ && chain_.own_limits();
  best_values_ = shows_ ? within_own_limits(middle_) : middle_;
  still_.assign(middle_.size(), 0);
}

std::vector<double> Search::within_own_limits(std::vector<double> values) const {
  const auto& [low, high] = *chain_.own_limits();
  for (std::size_t v = 0; v < values.size(); ++v)
    values[v] = std::clamp(values[v], low[v], high[v]);
  return values;
}

Bracket Search::nearest() const {
  if (verdict_ == Verdict::CanTouch || verdict_ == Verdict::Always) return {0, 0};
  double lower = begun_ ? proved_ : 0;
  if (!open_.empty()) lower = std::min(lower, open_.top().lower);
  return {std::clamp(lower, 0.0, nearest_), nearest_};
}

Contact::Nearest Search::measure(const std::vector<double>& values, std::size_t most_steps) {
  motion_.set(values, still_);
  Contact::Nearest out = inner_.nearest(motion_, 0, most_steps);
  if (out.upper < nearest_) {
    nearest_ = out.upper;
    best_values_ = values;
  }
  return out;
}

bool Search::shows(const std::vector<double>& values, std::size_t most_steps) {
  motion_.set(values, still_);
  const double depth = inner_.some_depth(motion_, most_steps);
  if (!(depth > 0)) return false;
  if (depth > depth_.lower) {
    depth_.lower = depth;
    best_values_ = values;
  }
  nearest_ = 0;
  verdict_ = Verdict::CanTouch;
  return true;
}

Search::Pull Search::pull(const std::vector<double>& values, const Target* target) {
  motion_.set(values, still_);
  const Transform& at = motion_.placed().b;
  if (target != nullptr) {
    const Vec3 from = at * target->in_b;
    return {from, target->in_a, (from - target->in_a).norm(), true};
  }
  const Cluster &a = inner_.a().tree()[0], &b = inner_.b().tree()[0];
  const Gap gap = inner_.gaps().at_middle(a, b, motion_, Vec3::Zero(), kInfinite);
  if (gap.upper > 1e-9 * inner_.gaps().reach()) {
    const double beyond = 0.1 * std::min(a.reach, b.reach);
    return {gap.on_b, gap.on_a + beyond / gap.upper * (gap.on_a - gap.on_b), gap.upper, true};
  }
  const Vec3 from = at * b.center;
  return {from, a.center, (from - a.center).norm(), false};
}

std::vector<double> Search::stepped(const std::vector<double>& values, const Pull& pull,
                                    double damping) {
  motion_.set(values, still_);
  const auto& [low, high] = *chain_.own_limits();
  std::vector<Vec3> columns(values.size(), Vec3::Zero());
  for (std::size_t k = 0; k < chain_.joints().size(); ++k) {
    const Chain::Joint& joint = chain_.joints()[k];
    const Vec3& axis = motion_.placed().axes[k];
    columns[joint.variable] +=
        joint.multiplier *
        (joint.revolute ? axis.cross(pull.from - motion_.placed().origins[k]).eval() : axis);
  }
  // Steps are shares of the limits' widths; what is at a limit does not go beyond it.
  for (std::size_t v = 0; v < values.size(); ++v) columns[v] *= half_[v];
  std::vector<double> step(values.size(), 0);
  std::vector<char> blocked(values.size(), 0);
  double scale = 0;
  for (const Vec3& column : columns) scale += column.squaredNorm();
  for (int pass = 0; pass < 4; ++pass) {
    Eigen::Matrix3d square = (damping * scale + 1e-300) * Eigen::Matrix3d::Identity();
    for (std::size_t v = 0; v < values.size(); ++v)
      if (blocked[v] == 0) square += columns[v] * columns[v].transpose();
    const Vec3 solved = square.ldlt().solve(pull.to - pull.from);
    bool again = false;
    for (std::size_t v = 0; v < values.size(); ++v) {
      step[v] = blocked[v] == 0 ? columns[v].dot(solved) : 0;
      if (!(step[v] > 0 ? values[v] >= high[v] : step[v] < 0 && values[v] <= low[v])) continue;
      step[v] = 0;
      blocked[v] = 1;
      again = true;
    }
    if (!again) break;
  }
  double most = 0.5;  // of the half widths
  for (const double s : step) most = std::max(most, std::abs(s));
  std::vector<double> out = values;
  for (std::size_t v = 0; v < values.size(); ++v)
    out[v] = std::clamp(values[v] + 0.5 / most * step[v] * half_[v], low[v], high[v]);
  return out;
}

bool Search::approach(std::vector<double> values, const Target* target) {
  values = within_own_limits(std::move(values));
  Pull at = pull(values, target);
  const double arrived = 1e-5 * inner_.gaps().reach();
  double damping = 1e-3;
  bool moved = true;
  int meeting = 0;  // places at which the hulls do
  for (int step = 0; step < 40 && damping < 1e3 && !stopped(); ++step) {
    if (moved && !at.apart && shows(values, kFewSteps)) return true;
    if (moved && !at.apart && ++meeting == 8) return false;
    if (at.distance <= arrived) break;
    std::vector<double> next = stepped(values, at, damping);
    const Pull there = pull(next, target);
    moved = there.apart == at.apart ? there.distance <= at.distance * (1 - 1e-3) : !there.apart;
    damping = moved ? std::max(1e-6, 0.1 * damping) : 10 * damping;
    if (!moved) continue;
    values = std::move(next);
    at = there;
  }
  return at.apart && shows(values, kFewSteps);
}

Search::Target Search::target(std::size_t i) const {
  const auto point = [&](const Surface& of, std::uint32_t base) {
    const Mesh& mesh = of.mesh();
    const auto count = static_cast<double>(mesh.triangles.size());
    const auto t = static_cast<std::size_t>(radical_inverse(i, base) * count);
    const geom::Triangle& corners = mesh.triangles[std::min(t, mesh.triangles.size() - 1)];
    const Vec3 &p = mesh.vertices[corners[0]], &q = mesh.vertices[corners[1]],
               &r = mesh.vertices[corners[2]];
    const Vec3 normal = (q - p).cross(r - p);
    const double length = normal.norm();
    // A little below the surface.
    const Vec3 middle = (p + q + r) / 3;
    return length > 0 ? (middle - 0.01 * of.tree()[0].reach / length * normal).eval() : middle;
  };
  return {point(inner_.a(), 2), point(inner_.b(), 3)};
}

std::vector<double> Search::sample(std::size_t i, const Chain::Limits& limits) const {
  const auto& [low, high] = limits;
  std::vector<double> values = middle_;
  for (std::size_t v = 0; v < values.size(); ++v)
    values[v] = std::clamp(values[v], low[v], high[v]);
  for (std::size_t v = 0; v < values.size() && i > 0; ++v)
    values[v] = low[v] + (high[v] - low[v]) * radical_inverse(i, kPrimes.at(v % kPrimes.size()));
  return values;
}

std::vector<std::vector<double>> Search::look_at_samples(const std::function<bool()>& stop) {
  const std::size_t samples =
      middle_.empty() ? 1 : std::min(samples_, std::max(kFirstSamples, 2 * sampled_));
  std::vector<std::pair<double, std::vector<double>>> near;
  const Cluster &a = inner_.a().tree()[0], &b = inner_.b().tree()[0];
  for (; sampled_ < samples && !stop(); ++sampled_) {
    std::vector<double> values = sample(sampled_, *chain_.own_limits());
    motion_.set(values, still_);
    const Gap gap = inner_.gaps().at_middle(a, b, motion_, Vec3::Zero(), kInfinite);
    if (gap.lower > 0 || !shows(values, always_ ? kManySteps : kFewSteps)) {
      always_ = false;
      near.emplace_back(gap.upper, std::move(values));
    }
    if (!always_ && verdict_ == Verdict::CanTouch) break;
  }
  std::ranges::stable_sort(near, {}, [](const auto& place) { return place.first; });
  std::vector<std::vector<double>> out;
  out.reserve(near.size());
  for (auto& place : near) out.push_back(std::move(place.second));
  return out;
}

bool Search::climb(std::vector<double> values, std::size_t most_steps) {
  const double touching = 1e-11 * inner_.gaps().reach();
  const auto& [low, high] = *chain_.own_limits();
  values = within_own_limits(std::move(values));
  Contact::Nearest at = measure(values, most_steps);
  for (int step = 0; step < 60 && at.upper > touching && !stopped(); ++step) {
    // Derivative of the distance: all joints move b.
    motion_.set(values, still_);
    const Vec3 along = (at.on_b - at.on_a) / at.upper;
    std::vector<double> gradient(values.size(), 0);
    for (std::size_t k = 0; k < chain_.joints().size(); ++k) {
      const Chain::Joint& joint = chain_.joints()[k];
      const Vec3& axis = motion_.placed().axes[k];
      gradient[joint.variable] +=
          joint.multiplier *
          along.dot(joint.revolute ? axis.cross(at.on_b - motion_.placed().origins[k]).eval()
                                   : axis);
    }
    double square = 0;
    for (std::size_t v = 0; v < values.size(); ++v) {
      const bool blocked = gradient[v] > 0 ? values[v] <= low[v] : values[v] >= high[v];
      if (blocked) gradient[v] = 0;
      square += gradient[v] * gradient[v];
    }
    if (!(square > 0)) break;
    // Beyond the touch, so that what touches is inside.
    double scale = 1.05 * at.upper / square;
    for (std::size_t v = 0; v < values.size(); ++v)
      if (std::abs(gradient[v]) * scale > 0.25 * half_[v])
        scale = 0.25 * half_[v] / std::abs(gradient[v]);
    bool better = false;
    for (int half = 0; half < 8 && !better && !stopped(); ++half, scale *= 0.4) {
      std::vector<double> next = values;
      for (std::size_t v = 0; v < values.size(); ++v)
        next[v] = std::clamp(values[v] - scale * gradient[v], low[v], high[v]);
      const Contact::Nearest there = measure(next, most_steps);
      if (there.upper >= at.upper * (1 - 1e-4)) continue;
      values = std::move(next);
      at = there;
      better = true;
    }
    if (!better) break;
  }
  if (at.upper > touching) return false;
  show_contact(std::move(values));
  return true;
}

void Search::show_contact(std::vector<double> values) {
  const auto& [low, high] = *chain_.own_limits();
  const auto depth_at = [&](const std::vector<double>& v) {
    motion_.set(v, still_);
    return inner_.depth_below(motion_, 40, 60);
  };
  double deepest = std::max(depth_.lower, depth_at(values));
  double overlap = outer_.depth_above_roughly(motion_);
  Random random(1);
  double width = 0.05;
  const int steps = deepest > 0 ? 20 : 100;
  for (int step = 0; step < steps && !values.empty() && !stopped(); ++step) {
    std::vector<double> next = values;
    for (std::size_t v = 0; v < next.size(); ++v)
      next[v] = std::clamp(next[v] + random.between(-1, 1) * width * half_[v], low[v], high[v]);
    // Where the hulls overlap more, the solids mostly do; that is cheap to see.
    motion_.set(next, still_);
    const double over = outer_.depth_above_roughly(motion_);
    const double there = over > overlap ? depth_at(next) : 0;
    if (there > deepest) {
      deepest = there;
      overlap = over;
      values = std::move(next);
      width = std::min(0.3, width * 1.5);
    } else {
      width = std::max(0.002, width * 0.93);
    }
  }
  nearest_ = 0;
  best_values_ = std::move(values);
  if (!(deepest > 0)) return;  // they touch up to rounding
  motion_.set(best_values_, still_);
  depth_ = {deepest, std::max(deepest, outer_.depth_above(motion_))};
  deepened_ = true;
  verdict_ = Verdict::CanTouch;
}

void Search::look_for_contacts(const std::function<bool()>& stop) {
  if (decided()) return;
  stop_ = &stop;
  searched_ = true;
  if (!shows_) return;
  const std::size_t round = rounds_++;
  const std::vector<std::vector<double>> near = look_at_samples(stop);
  const auto found = [&] { return verdict_ != Verdict::Open; };
  if (found()) return;
  for (std::size_t i = 0; i < near.size() && i < kClimbs && !stop(); ++i)
    if (approach(near[i], nullptr)) break;
  if (found()) return;
  for (std::size_t i = 0; i < kTargets && !near.empty() && !stop(); ++i) {
    const Target to = target(1 + round * kTargets + i);
    if (approach(near[i / 2 % near.size()], &to)) break;
  }
  if (found() || near.empty() || stop()) return;
  if (round == 0)
    measure(near.front(), kMostSteps / 4);
  else
    for (std::size_t i = 0; i < near.size() && i < kClimbs && !stop(); ++i)
      if (climb(near[i], kMostSteps) && verdict_ == Verdict::CanTouch) return;
}

void Search::look_deeper(const std::function<bool()>& stop) {
  if (verdict_ != Verdict::CanTouch || std::exchange(deepened_, true)) return;
  stop_ = &stop;
  show_contact(best_values_);
  std::size_t left = kAlwaysBoxes;
  if (always_ && meet_always(middle_, half_, left, stop)) verdict_ = Verdict::Always;
}

bool Search::meet_always(std::vector<double> middle, std::vector<double> half, std::size_t& left,
                         const std::function<bool()>& stop) {
  if (left == 0 || stop()) return false;
  --left;
  motion_.set(middle, half);
  const double deep = inner_.depth_below(motion_, 60, 100);
  if (!(deep > 0)) return false;
  const Cluster &a = (*tree_a_)[0], &b = (*tree_b_)[0];
  const Vec3 center = motion_.placed().b * b.center;
  if (motion_.bound(a.center, a.reach, center, b.reach).first < deep) return true;
  if (middle.empty()) return true;
  const std::size_t v = widest(motion_, {0, 0, Vec3::UnitZ()});
  if (half[v] < 1e-4) return false;
  half[v] *= 0.5 * (1 + 0x1p-40);
  std::vector<double> first = middle;
  first[v] -= half[v];
  middle[v] += half[v];
  return meet_always(first, half, left, stop) && meet_always(middle, half, left, stop);
}

std::size_t Search::widest(const BoxMotion& motion, const Item& worst) const {
  const Cluster &a = (*tree_a_)[worst.a], &b = (*tree_b_)[worst.b];
  const Vec3 center = motion.placed().b * b.center;
  const BoxMotion::Bound bound = motion.bound(a.center, a.reach, center, b.reach);
  std::vector<double> score(middle_.size(), 0);
  const bool by_first = bound.second > bound.first;
  const BoxMotion::Split split = by_first ? bound.first_split : bound.second_split;
  for (const bool of_b : {false, true}) {
    BoxMotion::Linear linear;
    motion.linear(worst.direction, split, of_b, linear);
    if (!by_first)
      for (std::size_t v = 0; v < linear.count; ++v)
        score[linear.variables[v]] +=
            std::abs(linear.coefficients[v].dot(of_b ? center : a.center) - linear.constants[v]);
    const std::size_t from = of_b ? split : 0, to = of_b ? chain_.joints().size() : split;
    for (std::size_t k = from; k < to; ++k) {
      const Chain::Joint& joint = chain_.joints()[k];
      const double half = motion.half_of(k);
      if (half == 0) continue;
      if (by_first)
        score[joint.variable] +=
            joint.revolute
                ? half * (motion.placed()
                              .axes[k]
                              .cross((of_b ? center : a.center) - motion.placed().origins[k])
                              .norm() +
                          (of_b ? b : a).reach)
                : half;
      else if (joint.revolute && motion.turns() > 0)
        score[joint.variable] += 2 * bound.second * half / motion.turns();
    }
  }
  return static_cast<std::size_t>(std::ranges::max_element(score) - score.begin());
}

void Search::look_at(std::vector<double> middle, std::vector<double> half, const Items& items) {
  ++looked_;
  motion_.set(middle, half);
  const Gaps& gaps = outer_.gaps();
  Items left, stack(items.rbegin(), items.rend());
  double worst = kInfinite;
  Item worst_item{};
  while (!stack.empty()) {
    Item item = stack.back();
    stack.pop_back();
    ++work_;
    const Cluster &a = (*tree_a_)[item.a], &b = (*tree_b_)[item.b];
    const double lower = gaps.lower(a, b, motion_, item.direction, 0);
    if (lower > 0) {
      proved_ = std::min(proved_, lower);
      continue;
    }
    const Vec3 center = motion_.placed().b * b.center;
    const double moves = motion_.bound(a.center, a.reach, center, b.reach).first;
    const bool cut_a = !a.leaf() && (b.leaf() || a.reach > b.reach);
    const double size = cut_a ? a.reach : b.leaf() ? 0 : b.reach;
    if (size > 0.7 * moves && left.size() + stack.size() < most_items_) {
      if (cut_a) {
        stack.push_back({a.right, item.b, item.direction});
        stack.push_back({a.left, item.b, item.direction});
      } else {
        stack.push_back({item.a, b.right, item.direction});
        stack.push_back({item.a, b.left, item.direction});
      }
      continue;
    }
    left.push_back(item);
    if (lower < worst) {
      worst = lower;
      worst_item = item;
    }
  }
  if (left.empty()) return;
  if (middle.empty()) {
    exhausted_ = true;
    proved_ = 0;
    return;
  }
  const std::size_t v = widest(motion_, worst_item);
  if (half[v] < 1e-10) {
    exhausted_ = true;  // rounding decides here
    proved_ = 0;
    return;
  }
  open_.push({worst, order_++, std::move(middle), std::move(half),
              std::make_shared<const Items>(std::move(left)), v});
}

void Search::end_proof() {
  // No surfaces meet anywhere; so what one solid holds of the other it holds everywhere.
  motion_.set(middle_, still_);
  Contact::Held held = outer_.held(motion_);
  // Any other configuration tells it as well.
  for (std::size_t i = 1; held == Contact::Held::Unclear && i < kPlaces && !middle_.empty(); ++i) {
    motion_.set(sample(i, *chain_.limits()), still_);
    if (outer_.held(motion_) == Contact::Held::Nothing) held = Contact::Held::Nothing;
  }
  motion_.set(middle_, still_);
  switch (held) {
    case Contact::Held::Nothing:
      verdict_ = Verdict::Never;
      break;
    case Contact::Held::Part:
      // The outer meshes' solids may be larger than the shapes. Inner ones have not been proved
      // apart: that they meet here says nothing of elsewhere.
      if (same_) {
        verdict_ = Verdict::Always;
        break;
      }
      if (std::size_t left = kAlwaysBoxes;
          shows_ && stop_ != nullptr && meet_always(middle_, half_, left, *stop_)) {
        verdict_ = Verdict::Always;
        break;
      }
      [[fallthrough]];
    default:
      shut_off_ = held == Contact::Held::Unclear;
      exhausted_ = true;
      proved_ = 0;
  }
}

void Search::take_apart(double distance, const std::function<bool()>& stop) {
  // Of joints' values beyond all turns, too, which the error grows with.
  const bool above_rounding =
      distance > 1e-6 * outer_.gaps().reach() + outer_.gaps().error() && distance < kInfinite;
  if (verdict_ != Verdict::Open || exhausted_ || !above_rounding) return;
  stop_ = &stop;
  begun_ = true;
  open_ = {};
  proved_ = distance;
  end_proof();
}

void Search::begin(const std::function<bool()>& stop) {
  if (exhausted_ || middle_.empty()) return;
  most_items_ = kFewItems;
  go_on(0, 0, stop);
  most_items_ = kMostItems;
}

void Search::go_on(std::size_t boxes, std::size_t work, const std::function<bool()>& stop) {
  if (verdict_ != Verdict::Open || exhausted_) return;
  stop_ = &stop;
  if (!begun_) {
    begun_ = true;
    if (middle_.empty()) most_items_ = kMostFixedItems;
    look_at(middle_, half_, {{0, 0, Vec3::Zero()}});
  }
  const std::size_t enough = work_ + work;
  for (std::size_t i = 0; i < boxes && work_ < enough && !open_.empty() && !exhausted_; ++i) {
    if (stop()) return;
    if (shows_ && looked_ >= next_climb_) {
      next_climb_ = looked_ + std::clamp<std::size_t>(looked_ / 2, 32, 2'000);
      if (!approach(open_.top().middle, nullptr)) climb(open_.top().middle, kMostSteps);
      if (verdict_ == Verdict::CanTouch) return;
    }
    const Box box = open_.top();
    open_.pop();
    std::vector<double> half = box.half, first = box.middle, second = box.middle;
    half[box.widest] *= 0.5 * (1 + 0x1p-40);
    first[box.widest] -= half[box.widest];
    second[box.widest] += half[box.widest];
    look_at(std::move(first), half, *box.items);
    look_at(std::move(second), half, *box.items);
  }
  if (open_.empty() && !exhausted_) end_proof();
}

std::optional<Search::Joint> Search::joint() const {
  if (chain_.joints().size() != 1 || !chain_.joints().front().revolute) return std::nullopt;
  // Of limits so large that rounding moves the links, nothing tells where they meet.
  if (!chain_.limits() || !(outer_.gaps().error() < 1e-6 * outer_.gaps().reach()))
    return std::nullopt;
  motion_.set(middle_, still_);
  Joint out{};
  out.in_a = motion_.placed().origins.front();
  const Transform& at = motion_.placed().b;
  out.in_b = at.linear.transpose() * (out.in_a - at.translation);
  out.beyond = (loose_ ? inner_ : outer_).farthest_meeting(motion_, out.in_a, out.in_b);
  return out;
}

}  // namespace kaboum::pairs::detail
