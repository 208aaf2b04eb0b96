// Contractions that move the vertices around with them: what one vertex cannot
// achieve alone, it may with its neighbours. Such a step is tried first without
// any certificate, with positions that need not bound the original, and taken
// back; where it promises something, nearly the same positions are sought by
// certified steps.

#include "neighbour_collapse.h"

#include <kaboum/geom/float32.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "optimise.h"

namespace kaboum::bmesh {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Share of the wrong side's deviations among the weights, at the end of a
/// trial.
constexpr double kPenalty = 3000;
constexpr int kRounds = 6;  ///< of a trial
/// The star must be within so many times the limit before the neighbours move,
/// and after some rounds, while deviations on the wrong side do not count much
/// yet; and all in the end.
struct Hopes {
  double before, meanwhile, finally;
};
/// Where the limit stays: nothing of what succeeded in 450 trials was beyond
/// this.
constexpr Hopes kThorough{2, 1.1, 1};
/// Where it rises, and what has failed comes back. Of 1600 trials 127
/// succeeded, 5, 3 and 8 % of these beyond these limits, and 48, 48 and 77 % of
/// those that failed.
constexpr Hopes kQuick{1.2, 0.88, 0.95};
constexpr int kLookAfter = 4;
/// Of the way to the best place that a vertex goes in a trial: all of it would overshoot, as its
/// neighbours move too.
constexpr double kRelaxed = 0.5;
/// A place of the original will do where it is that near: as a share of the
/// limit.
constexpr double kClose = 0.15;
constexpr int kSweeps = 2;           ///< of certified moves towards what the trial has found
constexpr int kPulls = 2;            ///< and of pulling back after them, if that is near the limit:
constexpr double kNearLimit = 1.15;  ///< within so many times of it
constexpr int kPlaces = 5;           ///< tried for the contracted vertex
/// A step that would fold a triangle is tried again with this share of it.
constexpr double kShortened = 0.3;

}  // namespace

NeighbourCollapse::NeighbourCollapse(const OptimiserContext& context, Optimiser& optimiser,
                                     StarStep& step)
    : OptimiserContext(context),
      optimiser_(optimiser),
      step_(step),
      before_(m_, sampled_, statistics_, steps_),
      mark_(m_.position.size(), 0) {}

/// Appends the neighbours of v that are not marked yet, and marks them.
void NeighbourCollapse::neighbours(std::uint32_t v, std::vector<std::uint32_t>& out) {
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
    for (std::uint32_t j = 1; j < 3; ++j) {
      const std::uint32_t w = m_.mesh[t][(k + j) % 3];
      if (mark_[w] == mark_value_) continue;
      mark_[w] = mark_value_;
      out.push_back(w);
    }
  });
}

/// The link condition, for an edge of two triangles between inner vertices.
bool NeighbourCollapse::satisfies_link_condition(std::uint32_t a, std::uint32_t b) {
  if (m_.border[a] != 0 || m_.border[b] != 0) return false;
  around_.clear();
  ++mark_value_;
  neighbours(a, around_);
  const std::uint32_t of_a = mark_value_++;
  int common = 0, together = 0;
  m_.mesh.for_each_triangle(b, [&](std::uint32_t t, std::uint32_t k) {
    const geom::Triangle& c = m_.mesh[t];
    for (const std::uint32_t w : {c[(k + 1) % 3], c[(k + 2) % 3]}) {
      together += w == a ? 1 : 0;
      if (mark_[w] == of_a) ++common, mark_[w] = mark_value_;
    }
  });
  if (together != 2 || common != 2) return false;
  // A triangle between the two common neighbours on both sides would fold onto
  // the other.
  const auto between = [&](std::uint32_t v) {
    bool found = false;
    m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
      const geom::Triangle& c = m_.mesh[t];
      found =
          found || (mark_[c[(k + 1) % 3]] == mark_value_ && mark_[c[(k + 2) % 3]] == mark_value_);
    });
    return found;
  };
  return !(between(a) && between(b));
}

/// Fills step_.removed and step_.added for the contraction of (a, b) to a
/// place. @return whether no triangle turns over.
bool NeighbourCollapse::gather_edge(std::uint32_t a, std::uint32_t b, const Vec3& to) {
  step_.removed.clear();
  step_.added.clear();
  bool good = true;
  const auto visit = [&](std::uint32_t t, std::uint32_t k, std::uint32_t other, bool again) {
    const geom::Triangle& c = m_.mesh[t];
    const std::uint32_t p = c[(k + 1) % 3], q = c[(k + 2) % 3];
    const bool vanishes = p == other || q == other;
    if (vanishes && again) return;
    step_.removed.push_back(t);
    if (vanishes) return;
    step_.added.push_back({t, {to, m_.position[p], m_.position[q]}});
    good = good && !folds(m_.normal[t], (m_.position[p] - to).cross(m_.position[q] - to));
  };
  m_.mesh.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) { visit(t, k, b, false); });
  m_.mesh.for_each_triangle(b, [&](std::uint32_t t, std::uint32_t k) { visit(t, k, a, true); });
  return good;
}

/// Carries out what gather_edge has described.
void NeighbourCollapse::contract(std::uint32_t a, std::uint32_t b, const Vec3& to) {
  sampled_.commit(step_.removed, step_.added);
  m_.mesh.contract(a, b);
  m_.position[a] = to;
  m_.update_normals_around(a);
}

/// Finds where the original is near to the points of the i-th star; after the first round from
/// where it was near before.
void NeighbourCollapse::follow(std::size_t i, double close, std::uint32_t& hint) {
  std::vector<std::uint32_t>& near = near_[i];
  if (near.empty()) step_.look_around_star(step_.added.front().corner[0], hint);
  near.resize(step_.points.size(), SampledError::kNone);
  for (std::size_t k = 0; k < near.size(); ++k) {
    SampledError::Point& point = step_.points[k];
    point.nearest = near[k];
    if (point.nearest == SampledError::kNone)
      sampled_.locate(point, hint, &step_.vicinity);
    else
      sampled_.locate_again(point, close * close);
    near[k] = point.nearest;
  }
}

/// Moves v, the i-th of around_, to where it deviates least, deviations on the
/// wrong side weighted by `penalty`; without any certificate.
void NeighbourCollapse::relax_vertex(std::size_t i, double scale, double penalty, double share,
                                     bool hand_over) {
  const std::uint32_t v = around_[i];
  if (!step_.gather(v)) return;
  const Vec3 from = m_.position[v];
  step_.place_star(from);
  follow(i, kClose * std::sqrt(scale), notes_.hint[v]);
  step_.linearise(from, scale, penalty);
  const auto step =
      minimise(step_.objective, {step_.objective.bx, step_.objective.by, step_.objective.bz}, {},
               kRegularisationDistance);
  if (!step || !step->allFinite()) return;
  Vec3 to = from + share * *step;
  if (step_.folds(to)) to = from + kShortened * share * *step;
  if (step_.folds(to)) return;
  if (hand_over) {
    step_.place_star(to);
    sampled_.commit(step_.removed, step_.added);
  }
  m_.position[v] = to;
  m_.update_normals_around(v);
}

/// Largest deviation of the star of v where that is above the limit, or something above it; else 0.
double NeighbourCollapse::star_largest(std::uint32_t v, double limit) {
  if (!step_.gather(v)) return kNoLimit;
  step_.place_star(m_.position[v]);
  return std::sqrt(sampled_.largest(step_.removed, step_.added, step_.points, notes_.hint[v],
                                    {limit * limit, limit * limit}));
}

/// Largest deviation of the triangles of the snapshot as they are now, where that
/// is between the bounds, or something above them; else 0. Leaves the triangles in
/// step_.added.
double NeighbourCollapse::region_largest(double least, double most) {
  alive_.clear();
  step_.added.clear();
  step_.points.clear();
  for (const std::uint32_t t : before_.triangles()) {
    if (!m_.mesh.alive(t)) continue;
    const geom::Triangle& c = m_.mesh[t];
    const std::array<Vec3, 3> p{m_.position[c[0]], m_.position[c[1]], m_.position[c[2]]};
    alive_.push_back(t);
    step_.added.push_back({t, p});
    step_.points.push_back({(p[0] + p[1] + p[2]) / 3.0, 0});
    for (int k = 0; k < 3; ++k) {
      const Vec3 &q = p[(k + 1) % 3], &r = p[(k + 2) % 3];
      if (c[k] < c[(k + 1) % 3]) {
        for (const double w : {0.25, 0.5, 0.75})
          step_.points.push_back({(1 - w) * p[k] + w * q, 0});
      }
      step_.points.push_back({p[k] / 6 + (q + r) * (5.0 / 12), 0});
      step_.points.push_back({p[k] * (2.0 / 3) + (q + r) / 6, 0});
    }
  }
  for (const std::uint32_t v : before_.vertices())
    if (m_.mesh.used(v)) step_.points.push_back({m_.position[v], 0});
  std::uint32_t& hint = notes_.hint[before_.vertices().front()];
  return std::sqrt(
      sampled_.largest(alive_, step_.added, step_.points, hint, {least * least, most * most}));
}

/// Tries the contraction without a certificate: fills target_ with where the
/// vertices of around_ should go. The mesh is as before afterwards. @return the
/// deviation then, or something above the limit; infinite where no place can be
/// certified.
double NeighbourCollapse::trial_collapse(std::uint32_t a, std::uint32_t b, double limit) {
  const Vec3 pa = m_.position[a], pb = m_.position[b], middle = 0.5 * (pa + pb);
  const auto start = [&] {
    for (const Vec3& p : {middle, pa, pb}) {
      if (!gather_edge(a, b, p)) continue;
      contract(a, b, p);
      return true;
    }
    return false;
  };
  if (!start()) return kNoLimit;
  const double scale = limit * limit;
  const Hopes& least = options_.epsilon ? kThorough : kQuick;
  near_.resize(std::max(near_.size(), around_.size()));
  for (std::size_t i = 0; i < around_.size(); ++i) near_[i].clear();
  for (int i = 0; i < 3; ++i) relax_vertex(0, scale, 1, 1, true);
  double deviation = 0;
  const auto hopes = [&](double share) {  // finds the limit that it would take
    deviation = star_largest(a, share * limit) / share;
    return deviation <= limit;
  };
  bool hopeful = hopes(least.before);
  for (int i = 1; i <= kRounds && hopeful; ++i) {
    const double penalty = std::pow(kPenalty, static_cast<double>(i) / kRounds);
    for (std::size_t k = 0; k < around_.size(); ++k)
      relax_vertex(k, scale, penalty, kRelaxed, i % 2 == 0);
    if (i == kLookAfter) hopeful = hopes(least.meanwhile);
  }
  const double last = least.finally * limit;
  if (hopeful) deviation = region_largest(last, last) / least.finally;
  target_.clear();
  for (const std::uint32_t v : around_) target_.push_back(m_.position[v]);
  before_.restore();
  return deviation;
}

/// A certified place near the wish for the contracted vertex; step_.removed and
/// step_.added describe the contraction to it.
std::optional<Vec3> NeighbourCollapse::find_position(std::uint32_t a, std::uint32_t b,
                                                     const Vec3& wish) {
  if (!gather_edge(a, b, wish)) return std::nullopt;
  const std::vector<std::uint32_t> removed = step_.removed;
  const std::vector<NewTriangle> added = step_.added;
  Quadric near;
  near.xx = near.yy = near.zz = 1;
  near.bx = -wish.x(), near.by = -wish.y(), near.bz = -wish.z();
  const auto holds = [&](const Vec3& p) {
    return gather_edge(a, b, p) && step_.stays_flat(p) && step_.is_certified(removed, p);
  };
  auto place = step_.place_against_original(removed, added, near, Vec3::Zero());
  for (int i = 0; i < kPlaces && place; ++i) {
    if (holds(*place)) return place;
    const Vec3 refused = *place;
    place = step_.next_place();
    if (place == refused) break;
  }
  if (options_.direction == Direction::Any) return std::nullopt;
  // Beyond all planes of the star, from where it can go back later.
  const double sign = options_.direction == Direction::Inner ? -1 : 1;
  const Vec3 spread = step_.rounding(wish);
  step_.planes.clear();
  for (const std::uint32_t t : removed) {
    const Vec3 n = sign * m_.normal[t];
    step_.planes.push_back(
        {n, kHalfSpacing * n.cwiseAbs().dot(spread) + n.dot(m_.position[m_.mesh[t][0]] - wish)});
  }
  const auto step = minimise(step_.objective, Vec3::Zero(), step_.planes, kRegularisationDistance);
  if (!step) return std::nullopt;
  Vec3 to = wish + *step;
  if (options_.precision == Precision::Float) to = geom::to_float32(to);
  return to.allFinite() && holds(to) ? std::optional<Vec3>(to) : std::nullopt;
}

/// Moves the vertices towards where the trial has them, by certified steps, and pulls them back
/// where the deviation is little beyond the limit then. @return the deviation where that is above
/// the limit, or something above it; else less.
double NeighbourCollapse::settle(double limit) {
  const double most = kNearLimit * limit;
  double deviation = 0;
  for (int k = 0; k < kSweeps && !(deviation > most); ++k) {
    for (std::size_t i = 0; i < around_.size(); ++i)
      optimiser_.move_towards(around_[i], target_[i], false);
    deviation = region_largest(limit, most);
  }
  for (int k = 0; k < kPulls && deviation > limit && !(deviation > most); ++k) {
    for (const std::uint32_t v : around_) {
      notes_.movable[v] = 1;
      optimiser_.pull_back(v, false);
    }
    deviation = region_largest(limit, most);
  }
  return deviation;
}

double NeighbourCollapse::collapse(std::uint32_t a, std::uint32_t b, double limit) {
  if (!satisfies_link_condition(a, b)) return kNoLimit;
  // The vertices that may move, and b.
  around_.assign({a, b});
  ++mark_value_;
  mark_[a] = mark_[b] = mark_value_;
  neighbours(a, around_);
  neighbours(b, around_);
  // Where no place is certified now, hardly any will be when the vertices
  // around have moved.
  if (!find_position(a, b, 0.5 * (m_.position[a] + m_.position[b]))) return kNoLimit;
  before_.take(around_);
  std::erase(around_, b);
  double deviation = trial_collapse(a, b, limit);
  if (deviation > limit) return deviation;

  const auto give_up = [&](std::uint64_t& counter) {
    ++counter;
    before_.restore();
  };
  for (std::size_t i = 1; i < around_.size(); ++i)
    optimiser_.move_towards(around_[i], target_[i], false);
  const auto place = find_position(a, b, target_[0]);
  if (!place) {
    give_up(statistics_.rejected_original);
    return kNoLimit;
  }
  contract(a, b, *place);
  if (steps_ != nullptr) steps_->push_back({a, b, *place});
  deviation = settle(limit);
  if (deviation > limit) {
    give_up(statistics_.rejected_distance);
    return deviation;
  }
  if (certificate_ != nullptr) {
    if (!certificate_->admits(before_.triangles(), step_.added)) {
      give_up(statistics_.rejected_distance);
      return limit;
    }
    certificate_->commit(before_.triangles());
  }
  ++statistics_.contractions;
  for (const std::uint32_t v : around_) optimiser_.disturb(v);
  return 0;
}

}  // namespace kaboum::bmesh
