// The stages of a decimation. [gaschler2016] §4.3, Algorithms 1 and 2, gives the contractions; the
// stages, measured distances and optimisation: docs/algorithms/bounding-mesh.md.

#include "decimator.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "compact.h"
#include "float_snap.h"

namespace kaboum::bmesh {

Decimator::Decimator(const Context& context, const geom::Mesh& original, PartialMesh start,
                     std::optional<ReferenceSolid>& solid, std::vector<Step>* steps,
                     const std::optional<RisingBound>& rising, bool sketch)
    : state_(context, original, std::move(start), solid, steps, rising),
      policy_(state_),
      clusters_(state_),
      sketch_(sketch) {}

DecimateResult Decimator::run(std::optional<std::size_t> target) {
  const Stop stop = contract_all(target);
  DecimateResult result;
  if (state_.options.precision == Precision::Float)
    result.unrepresentable = FloatSnap(state_, policy_).run();
  result.stop = stop;
  result.out_of_work = state_.ended_early;
  result.mesh = compact(state_.mesh().position, state_.mesh().mesh);
  result.statistics = state_.contraction.statistics();
  return result;
}

void Decimator::nest_in(const geom::Mesh& level) {
  state_.bound = &level;
  if (state_.reference) state_.reference.emplace(level);
  if (follows_distances()) {
    if (state_.optimiser) start_optimising();
    return;
  }
  // Contractions to come are not measured; the next rounds begin anew.
  state_.measuring = false;
  state_.optimiser.reset();
  state_.sampled.reset();
}

/// Whether distances are followed while contracting, not only in the end.
bool Decimator::follows_distances() const { return measured_from(state_.options, 1) > 1; }

Stop Decimator::contract_all(const std::optional<std::size_t>& wanted) {
  const std::size_t target = wanted.value_or(0);
  if (!follows_distances()) {
    contract_to(target);
  } else {
    start_stages(target);
    contract_in_stages(target);
  }
  optimise(state_.options.effort == Effort::Best ? kFinalPassesBest : kFinalPasses);
  if (wanted && state_.vertices() <= target) return Stop::VertexTarget;
  if (state_.spent(kNoneContracts) || (state_.most_epsilon > 0 && state_.spent(kNoneMoves)))
    return Stop::OutOfWork;
  return state_.bounded ? Stop::ErrorBound : Stop::Exhausted;
}

void Decimator::start_stages(std::size_t target) {
  const DecimateOptions& options = state_.options;
  if (!state_.measuring) {
    // Small deviations need no measuring: the quadrics order the contractions as well.
    contract_to(measured_from(options, target), options.epsilon && options.cost == Cost::Distance
                                                    ? kMeasureFromEpsilon * *options.epsilon
                                                    : std::numeric_limits<double>::infinity());
    start_measuring();
  }
  if (options.cost != Cost::Distance || !state_.optimiser || state_.epsilon) return;
  const auto wanted = static_cast<double>(target);
  if (static_cast<double>(state_.original.vertices.size()) <= kRefineMost * wanted) {
    for (const double multiple : kRefineAt) {
      contract_to(static_cast<std::size_t>(multiple * wanted));
      refine();
    }
  }
  const double from = options.effort == Effort::Best ? kClusterFromBest : kClusterFrom;
  contract_to(static_cast<std::size_t>(from * wanted));
  reached_alone_ = state_.reached;
}

void Decimator::contract_in_stages(std::size_t target) {
  if (state_.options.cost == Cost::Distance && state_.optimiser && !state_.epsilon && !sketch_)
    collapse_in_rounds(target);
  contract_to(target);
  if (state_.most_epsilon > 0) return raise_bound(target);
  if (!state_.epsilon || state_.options.effort == Effort::Fast) return;
  // What is given back makes room for further contractions within the error bound.
  take_turns(target, [&] {
    optimise(kStagePasses);
    contract_to(target);
  });
  if (!state_.in_clusters || !state_.optimiser) return;
  take_turns(target, [&] {
    collapse_within(target);
    optimise(kStagePasses);
  });
}

/// Repeats what contracts, as long as it takes a share of the vertices.
template <class Turn>
void Decimator::take_turns(std::size_t target, Turn&& turn) {
  for (std::size_t before = 2 * state_.vertices();
       !state_.spent(kNoneMoves) && state_.vertices() > target &&
       100 * state_.vertices() < (100 - kTurnPercent) * before;) {
    before = state_.vertices();
    turn();
  }
}

/// Contracts edges together with moves within the deviation reached, then within more and more.
void Decimator::collapse_in_rounds(std::size_t target) {
  clusters_.forget_failures();  // of an earlier level of a series
  // Where hardly anything is contracted, nothing has been reached, and little is to be gained.
  double limit = state_.reached > 0 ? std::min(state_.reached, state_.context.diagonal) : 0;
  clusters_.be_patient();
  for (int i = 0;
       i < kClusterRounds && limit > 0 && state_.vertices() > target && !state_.spent(kNoneMoves);
       ++i, limit *= kClusterGrowth) {
    if (i == 0 || 100 * state_.vertices() <= (100 - kRefineAgain) * refined_) refine();
    optimise(1);
    clusters_.run(target, limit);
    if (clusters_.out_of_patience()) break;
  }
}

/// The same within the error bound, as often as need be.
void Decimator::collapse_within(std::size_t target) {
  clusters_.be_endlessly_patient();
  clusters_.run(target, *state_.epsilon);
}

void Decimator::raise_bound_by(double growth, std::size_t target) {
  double& epsilon = *state_.epsilon;
  epsilon = std::min(growth * epsilon, state_.most_epsilon);
  state_.carried->raise(epsilon);
  contract_to(target);
}

/// Goes on within a larger and larger error bound: as long as there are many vertices, by
/// contractions alone.
void Decimator::raise_bound(std::size_t target) {
  const double& epsilon = *state_.epsilon;
  while (static_cast<double>(state_.vertices()) > state_.alone * static_cast<double>(target) &&
         epsilon < state_.most_epsilon && !state_.spent(kNoneMoves))
    raise_bound_by(kBoundGrowthAlone, target);
  double growth = kBoundGrowth;
  for (;;) {
    const auto missing = static_cast<double>(state_.vertices() - target);
    optimise(kBoundPasses);
    collapse_within(target);
    if (state_.vertices() <= target || epsilon >= state_.most_epsilon || state_.spent(kNoneMoves))
      return;
    raise_bound_by(growth, target);
    if (state_.vertices() <= target) return;
    const bool gained =
        static_cast<double>(state_.vertices() - target) < (1 - kBoundGain) * missing;
    growth = gained ? kBoundGrowth : std::min(growth * growth, kBoundMostGrowth);
  }
}

/// Samples are added where the mesh deviates most, if it has changed.
void Decimator::refine() {
  if (!(state_.reached > 0) || state_.vertices() == refined_ || state_.spent(kNoneMoves)) return;
  refined_ = state_.vertices();
  const double far = kRefineFrom * state_.reached;
  state_.sampled->refine(state_.mesh().position, state_.mesh().mesh, far * far);
}

/// Contracts until `target` vertices are left or the next costs more than `limit`.
void Decimator::contract_to(std::size_t target, double limit) {
  for (bool progress = true;
       progress && state_.vertices() > target && !state_.spent(kNoneContracts);) {
    state_.bounded = false;
    progress = state_.contraction.pass(target, limit, &policy_) && limit == Contraction::kNoLimit;
    if (state_.hurries || !state_.measuring || !state_.spent(kNoneMoves)) continue;
    if (state_.most_epsilon > 0) break;  // what has been found without a bound will do
    policy_.pull_back_recent();
    state_.hurries = progress = true;
  }
  policy_.pull_back_recent();
}

void Decimator::start_measuring() {
  state_.start_measuring();
  policy_.begin_measuring();
  if (state_.options.effort != Effort::Fast) start_optimising();
}

void Decimator::start_optimising() {
  state_.start_optimising();
  policy_.forget_refusals();
}

void Decimator::optimise(int passes) {
  if (state_.options.effort == Effort::Fast || state_.hurries || state_.spent(kNoneMoves)) return;
  if (!state_.sampled) start_measuring();
  if (!state_.optimiser) return;
  for (int i = 0; i < passes && !state_.spent(kNoneMoves); ++i)
    if (state_.optimiser->pass() == 0) break;
}

}  // namespace kaboum::bmesh
