// Coordinates that float32 can hold, by certified steps. docs/algorithms/bounding-mesh.md.

#include "float_snap.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <array>
#include <optional>

#include "loosen.h"

namespace kaboum::bmesh {
namespace {

/// So many times as far from the planes as rounding asks for: tried in turn.
constexpr std::array<double, 3> kCare{1, 4, 16};

}  // namespace

std::size_t FloatSnap::run() {
  const WorkingMesh& m = state_.mesh();
  std::vector<std::uint32_t> left;
  for (std::uint32_t v = 0; v < m.position.size(); ++v)
    if (m.mesh.used(v) && !geom::is_float32(m.position[v])) left.push_back(v);
  const auto take_out = [&](auto&& helps) {
    const std::size_t before = left.size();
    std::erase_if(
        left, [&](std::uint32_t v) { return !m.mesh.used(v) || (m.border[v] == 0 && helps(v)); });
    return left.size() < before;
  };
  // What fails now may succeed once a neighbour has moved.
  do {
    while (take_out([&](std::uint32_t v) {
      return move(v) || (state_.optimiser && state_.optimiser->single().snap_to_float(v));
    })) {
    }
  } while (take_out([&](std::uint32_t v) { return contract_away(v); }) ||
           take_out([&](std::uint32_t v) { return make_room(v); }) ||
           take_out([&](std::uint32_t v) { return move(v, true); }));
  policy_.pull_back_recent();
  return left.size();
}

/// Flips edges of v until it can be moved, or contracted away.
bool FloatSnap::make_room(std::uint32_t v) {
  if (state_.options.keep_convex || !state_.context.constrained) return false;
  Loosener loosener(state_.context, state_.mesh(), state_.solid(), state_.certificate(),
                    state_.measuring ? &*state_.sampled : nullptr, state_.steps,
                    state_.contraction.statistics());
  while (loosener.loosen(v)) {
    if (state_.optimiser) state_.optimiser->single().disturb(v);
    if (move(v) || contract_away(v)) return true;
  }
  return false;
}

/// Contracts the cheapest admissible edge of v.
bool FloatSnap::contract_away(std::uint32_t v) {
  Contraction& contraction = state_.contraction;
  const Connectivity& mesh = state_.mesh().mesh;
  std::vector<std::uint32_t> neighbours;
  mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
    for (std::uint32_t j = 1; j < 3; ++j) neighbours.push_back(mesh[t][(k + j) % 3]);
  });
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  constexpr auto kAny = CollapseEvaluator::Purpose::Any;
  constexpr auto kValid = CollapseEvaluator::Validity::Valid;
  const CollapseEvaluator::Candidate& candidate = contraction.evaluator().candidate();
  std::optional<CollapseEvaluator::Candidate> best;
  for (const std::uint32_t w : neighbours) {
    if (contraction.evaluate(v, w, kAny) != kValid || !geom::is_float32(candidate.position))
      continue;
    if (best && best->cost <= candidate.cost) continue;
    const CollapseEvaluator::Candidate found = candidate;
    if (policy_.admissible()) best = found;
  }
  if (!best) return false;
  ensure(contraction.evaluate(best->a, best->b, kAny) == kValid && policy_.admissible(),
         "an admitted contraction is no longer admissible");
  contraction.apply(&policy_);
  return true;
}

bool FloatSnap::move(std::uint32_t v, bool may_fold) {
  CollapseEvaluator& evaluator = state_.contraction.evaluator();
  for (const double care : kCare) {
    if (!evaluator.evaluate_move(v, care, may_fold)) continue;
    if (state_.carried || state_.measuring) evaluator.describe(removed_, added_);
    if (state_.carried) {
      if (!state_.carried->admits(removed_, added_)) continue;
      state_.carried->commit(removed_);
    }
    if (state_.measuring) state_.sampled->commit(removed_, added_);
    const Vec3& to = evaluator.candidate().position;
    state_.mesh().position[v] = to;
    state_.mesh().update_normals_around(v);
    if (state_.steps != nullptr) state_.steps->push_back({v, v, to});
    ++state_.contraction.statistics().moves;
    return true;
  }
  return false;
}

}  // namespace kaboum::bmesh
