// Vertices are moved towards the original and edges flipped, by steps that are
// certified against it. docs/algorithms/bounding-mesh.md, "Steps against the
// original".

#include "optimise.h"

#include <kaboum/geom/float32.h>

#include <limits>

namespace kaboum::bmesh {
namespace {

/// A step must lower the energy by this share at least: those that gain less
/// take most of the time, and nothing is lost without them.
constexpr double kGain = 0.02;
/// Share of the way to the best place that a vertex goes at a time: if each
/// went all the way, the first ones would leave their neighbours no room.
constexpr double kDamping = 0.5;
/// Placements tried for a vertex, each with what the one before cut off the
/// original as constraint.
constexpr int kAttempts = 5;

}  // namespace

Optimiser::Optimiser(const OptimiserContext& context, ReferenceSolid* solid,
                     const geom::Mesh& original)
    : OptimiserContext(context),
      step_(m_, sampled_, solid, original, options_, statistics_, steps_),
      collapse_(*this, *this, step_) {}

void Optimiser::disturb(std::uint32_t v) {
  notes_.disturb(v);
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : m_.mesh[t]) notes_.disturb(w);
  });
}

bool Optimiser::pull_back(std::uint32_t v, bool alone) {
  if (notes_.movable[v] == 0 || !step_.gather(v)) return false;
  notes_.movable[v] = 0;
  const Vec3 from = m_.position[v];
  step_.place_star(from);
  std::uint32_t& hint = notes_.hint[v];
  step_.look_around_star(from, hint);
  const auto before =
      sampled_.energy(step_.removed, step_.added, step_.points, hint,
                      std::numeric_limits<double>::infinity(), {.vicinity = &step_.vicinity});
  if (!(before.squared > 0)) return false;
  const SampledError::Locating again{.again = true, .vicinity = &step_.vicinity};
  step_.linearise(from, before.squared);
  step_.bound_by_star();
  const double goal = (1 - kGain) * before.sum;
  Vec3 refused = from;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    step_.support.half_spaces(step_.rounding(from), step_.planes);
    const auto step =
        minimise(step_.objective, {step_.objective.bx, step_.objective.by, step_.objective.bz},
                 step_.planes, kRegularisationDistance);
    if (!step) return false;
    Vec3 to = from + kDamping * *step;
    if (options_.precision == Precision::Float) to = geom::to_float32(to);
    if (to == from || !to.allFinite()) return false;
    step_.place_star(to);
    const auto after = sampled_.energy(step_.removed, step_.added, step_.points, hint, goal, again);
    if (step_.folds(to) || !(after.sum < goal)) {
      // Linearised too boldly, perhaps.
      to = from + 0.5 * kDamping * *step;
      if (options_.precision == Precision::Float) to = geom::to_float32(to);
      if (to == from || step_.folds(to)) return false;
      step_.place_star(to);
      if (!(sampled_.energy(step_.removed, step_.added, step_.points, hint, goal, again).sum <
            goal))
        return false;
    }
    if (to == refused || !step_.stays_flat(to)) return false;
    if (!step_.does_not_cut_original(step_.removed, true, to)) {
      ++statistics_.rejected_original;
      refused = to;
      continue;
    }
    if (alone && certificate_ != nullptr) {
      if (!certificate_->admits(step_.removed, step_.added)) {
        ++statistics_.rejected_distance;
        return false;
      }
      certificate_->commit(step_.removed);
    }
    step_.move(v, to);
    disturb(v);
    return true;
  }
  return false;
}

/// Moves v as near to the target as the original allows, by a certified step;
/// not if that leads away from it. @param alone  the error bound is kept by
/// this step itself
bool Optimiser::move_towards(std::uint32_t v, const Vec3& target, bool alone) {
  if (!step_.gather(v)) return false;
  const Vec3 from = m_.position[v], wish = from - target;
  step_.place_star(from);
  step_.bound_by_star();
  step_.objective = {};
  step_.objective.xx = step_.objective.yy = step_.objective.zz = 1;
  Vec3 refused = from;
  for (int i = 0; i < kAttempts; ++i) {
    step_.support.half_spaces(step_.rounding(from), step_.planes);
    const auto step = minimise(step_.objective, wish, step_.planes, kRegularisationDistance);
    if (!step) return false;
    Vec3 to = from + *step;
    if (options_.precision == Precision::Float) to = geom::to_float32(to);
    if (to == from || to == refused || !to.allFinite() || step_.folds(to)) return false;
    if (target != from && (to - target).squaredNorm() >= wish.squaredNorm()) return false;
    step_.place_star(to);
    if (!step_.stays_flat(to)) return false;
    if (!step_.does_not_cut_original(step_.removed, true, to)) {
      ++statistics_.rejected_original;
      refused = to;
      continue;
    }
    if (alone && certificate_ != nullptr) {
      if (!certificate_->admits(step_.removed, step_.added)) return false;
      certificate_->commit(step_.removed);
    }
    step_.move(v, to);
    return true;
  }
  return false;
}

bool Optimiser::snap_to_float(std::uint32_t v) { return move_towards(v, m_.position[v], true); }

bool Optimiser::flip(std::uint32_t a, std::uint32_t b) {
  // The two triangles (a, b, c) and (b, a, d) of a manifold edge.
  std::uint32_t first = 0, second = 0, c = 0, d = 0;
  int forward = 0, backward = 0;
  m_.mesh.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) {
    const geom::Triangle& tri = m_.mesh[t];
    if (tri[(k + 1) % 3] == b) {
      ++forward;
      first = t;
      c = tri[(k + 2) % 3];
    }
    if (tri[(k + 2) % 3] == b) {
      ++backward;
      second = t;
      d = tri[(k + 1) % 3];
    }
  });
  if (forward != 1 || backward != 1 || c == d) return false;
  bool joined = false;
  m_.mesh.for_each_triangle(c, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : m_.mesh[t]) joined = joined || w == d;
  });
  if (joined) return false;
  const Vec3 &pa = m_.position[a], &pb = m_.position[b], &pc = m_.position[c], &pd = m_.position[d];
  // Neither new triangle may turn over.
  const Vec3 mean = m_.normal[first] + m_.normal[second];
  for (const Vec3& n : {Vec3((pd - pa).cross(pc - pa)), Vec3((pb - pd).cross(pc - pd))}) {
    if (folds(mean, n, mean.squaredNorm())) return false;
  }
  const auto measure = [&](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s,
                           double limit) {
    // Triangles (p, q, r) and (q, p, s) on the edge (p, q).
    step_.added.clear();
    step_.added.push_back({first, {p, q, r}});
    step_.added.push_back({second, {q, p, s}});
    const double a1 = area(step_.added[0].corner), a2 = area(step_.added[1].corner);
    step_.points.clear();
    step_.points.push_back({0.5 * (p + q), (a1 + a2) / 3});
    step_.points.push_back({(p + q + r) / 3.0, a1 / 2});
    step_.points.push_back({(q + p + s) / 3.0, a2 / 2});
    return sampled_.energy(step_.removed, step_.added, step_.points, notes_.hint[a], limit);
  };
  step_.removed.assign({first, second});
  const auto before = measure(pa, pb, pc, pd, std::numeric_limits<double>::infinity());
  // (a, d, c) and (d, b, c) are (d, c, a) and (c, d, b).
  const double limit = (1 - kGain) * before.sum;
  const auto after = measure(pd, pc, pa, pb, limit);
  if (!(after.sum < limit)) return false;
  if (!step_.certified(first, pd) || !step_.stays_flat(pd)) {
    ++statistics_.rejected_original;
    return false;
  }
  if (certificate_ != nullptr) {
    if (!certificate_->admits(step_.removed, step_.added)) {
      ++statistics_.rejected_distance;
      return false;
    }
    certificate_->commit(step_.removed);
  }
  sampled_.commit(step_.removed, step_.added);
  m_.mesh.replace(first, {d, c, a});
  m_.mesh.replace(second, {c, d, b});
  m_.update_normal(first);
  m_.update_normal(second);
  if (steps_ != nullptr) steps_->push_back(Step::flip(a, b, c, d));
  ++statistics_.flips;
  for (const std::uint32_t v : {a, b, c, d}) notes_.disturb(v);
  return true;
}

double Optimiser::collapse_with_neighbours(std::uint32_t a, std::uint32_t b, double limit) {
  return collapse_.collapse(a, b, limit);
}

}  // namespace kaboum::bmesh
