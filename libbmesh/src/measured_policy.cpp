// Costs of contractions as measured distances, and places for their vertices that the original
// bounds. docs/algorithms/bounding-mesh.md, "Steps against the original".

#include "measured_policy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::bmesh {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// So many contractions are made before their vertices are pulled back, and no more than one for so
/// many vertices that are left: the contractions to come should see them where they belong.
constexpr std::size_t kRecent = 32, kRecentShare = 256;
/// Measuring stops when the distance exceeds what is due by this factor: far enough beyond it that
/// the edge does not come back time and again.
constexpr double kMeasureTo = 2;
/// What is due before it is measured at more points may turn out to be this much farther.
constexpr double kDenselyTo = 1.2;
/// A spike goes farther from the original than this share of the diagonal, and this many times
/// farther than the original is from the new triangles there.
constexpr double kSpike = 0.05, kSpikeRatio = 3;
/// Places tried for one vertex that the original bounds.
constexpr int kMeasuredPlaces = 5;
/// Progress is told once for so many contractions.
constexpr std::size_t kProgress = 1024;
/// The star of an edge was measured before, but not as it is.
constexpr std::uint32_t kUnmeasured = ~0U;

}  // namespace

void MeasuredPolicy::begin_measuring() {
  hint_.assign(state_.mesh().position.size(), 0);
  around_.assign(state_.mesh().position.size(), 0);
}

CollapseEvaluator::Purpose MeasuredPolicy::purpose() const {
  return state_.optimiser && !state_.hurries ? CollapseEvaluator::Purpose::AgainstOriginal
                                             : CollapseEvaluator::Purpose::Due;
}

bool MeasuredPolicy::goes_on() {
  return !state_.spent(state_.measuring && !state_.hurries ? kNoneMoves : kNoneContracts);
}

/// What was refused is refused again, unless something has changed around it or the error bound has
/// risen to what it takes.
bool MeasuredPolicy::is_hopeful(const BucketQueue::Entry& e) {
  if (!state_.optimiser || state_.hurries) return true;
  const auto at = refusals_.find(edge_key(e.a, e.b));
  if (at == refusals_.end()) return true;
  const Refusal& r = at->second;
  if (r.version != state_.optimiser->version(e.a, e.b)) return true;
  if (state_.epsilon && !(r.takes > *state_.epsilon)) return true;
  state_.bounded = state_.bounded || r.by_epsilon;
  return false;
}

void MeasuredPolicy::has_no_place(const BucketQueue::Entry& e) { refuse(e.a, e.b, kNever, false); }

void MeasuredPolicy::refuse(std::uint32_t a, std::uint32_t b, double takes, bool by_epsilon) {
  if (state_.optimiser)
    refusals_[edge_key(a, b)] = {state_.optimiser->version(a, b), takes, by_epsilon};
}

/// Refuses the candidate for good. @return false
bool MeasuredPolicy::reject(std::uint64_t& counter) {
  ++counter;
  refuse(candidate().a, candidate().b, kNever, false);
  return false;
}

/// The same, until the error bound is above what it takes.
bool MeasuredPolicy::reject_by_epsilon(double takes) {
  ++statistics().rejected_distance;
  state_.bounded = true;
  refuse(candidate().a, candidate().b, std::nextafter(takes, kNever), true);
  return false;
}

bool MeasuredPolicy::assess(BucketQueue::Entry& e) {
  if (state_.hurries) return true;
  if (state_.optimiser && !place_against_original()) return false;
  if (!state_.measuring) return true;
  if (e.measured == around_[e.a] + around_[e.b]) {
    candidate().cost = 0;
    return true;
  }
  return !state_.contraction.queue().due(candidate().cost) || measure(e);
}

bool MeasuredPolicy::admit(BucketQueue::Entry& e) {
  if (state_.hurries) return admissible();
  if (candidate().against_original) {
    if (!certify(e)) return false;
    if (!state_.contraction.queue().due(candidate().cost)) return state_.contraction.postpone(e);
  }
  return measure_densely(e) && admissible();
}

bool MeasuredPolicy::admissible() {
  if (!evaluator().keeps_shape()) {
    refuse(candidate().a, candidate().b, kNever, false);
    return false;
  }
  if (!state_.carried) return true;
  describe_change();
  return state_.carried->admits(removed_, added_) || reject_by_epsilon(*state_.epsilon);
}

void MeasuredPolicy::before() {
  if (state_.carried) state_.carried->commit(removed_);
  if (!state_.measuring) return;
  describe_change();
  state_.sampled->commit(removed_, added_);
}

void MeasuredPolicy::after() {
  const std::uint32_t v = candidate().a;
  if (state_.measuring) {
    state_.reached = std::max(state_.reached, state_.contraction.queue().lowest_key());
    star_changed(v);
  }
  if (state_.optimiser && !state_.hurries) {
    state_.optimiser->single().disturb(v);
    recent_.push_back(v);
    if (!state_.optimiser->in_batches() ||
        recent_.size() >= std::min(kRecent, state_.vertices() / kRecentShare))
      pull_back_recent();
  }
  if (state_.options.progress && statistics().contractions % kProgress == 0)
    state_.options.progress(state_.vertices());
}

void MeasuredPolicy::pull_back_recent() {
  if (recent_.empty() || state_.hurries) return;
  state_.optimiser->pull_back(recent_, [&](std::uint32_t v) { star_changed(v); });
  recent_.clear();
}

/// The star of v is not what has been measured.
void MeasuredPolicy::star_changed(std::uint32_t v) {
  ++around_[v];
  for (const std::uint32_t w : evaluator().neighbours(v)) ++around_[w];
}

/// Replaces the cost by the measured distance; when that turns out to be beyond what is due, the
/// edge goes back into the queue with what is known. @return whether the cost is known.
bool MeasuredPolicy::measure(BucketQueue::Entry& e) {
  describe_change();
  describe_points();
  CollapseEvaluator::Candidate& c = candidate();
  if (state_.options.cost == Cost::Mean)  // whose cost is the quadric's
    return !spikes() || reject(statistics().rejected_spike);
  const std::optional<double>& epsilon = state_.epsilon;
  double limit = kMeasureTo * std::max(state_.contraction.queue().lowest_key(), c.cost);
  if (epsilon) limit = std::min(limit, std::max(*epsilon, c.cost));
  // The key is a cost already: what is nearer adds nothing.
  const double squared = state_.sampled->largest(removed_, added_, points_, hint_[e.a],
                                                 {c.cost * c.cost, limit * limit});
  c.cost = std::max(c.cost, std::sqrt(squared));
  if (epsilon && c.cost > *epsilon) return reject_by_epsilon(c.cost);
  if (c.cost > limit) {
    e.measured = kUnmeasured;
    return state_.contraction.postpone(e);
  }
  if (c.cost > kSpike * state_.context.diagonal && spikes())
    return reject(statistics().rejected_spike);
  e.measured = around_[e.a] + around_[e.b];
  return true;
}

/// The new triangles at more points, before they are made; what is found to be beyond what is due
/// goes back into the queue. @return whether it is not.
bool MeasuredPolicy::measure_densely(BucketQueue::Entry& e) {
  if (!state_.measuring || state_.options.cost != Cost::Distance || state_.epsilon) return true;
  describe_change();
  points_.clear();
  for (const NewTriangle& t : added_) {
    const auto& [v, p, q] = t.corner;
    points_.push_back({0.75 * v + 0.25 * p, 0});
    points_.push_back({0.25 * v + 0.75 * p, 0});
    for (int k = 0; k < 3; ++k) points_.push_back({0.5 * t.corner[k] + (v + p + q) / 6, 0});
  }
  const double limit = kDenselyTo * state_.contraction.queue().lowest_key();
  const double squared =
      state_.sampled->largest({}, {}, points_, hint_[e.a], {limit * limit, limit * limit});
  if (!(squared > 0)) return true;
  candidate().cost = std::max(candidate().cost, std::sqrt(squared));
  e.measured = kUnmeasured;
  return state_.contraction.postpone(e);
}

void MeasuredPolicy::describe_points() {
  points_.clear();
  points_.push_back({candidate().position, 0});
  for (const NewTriangle& t : added_) {
    points_.push_back({0.5 * (t.corner[0] + t.corner[1]), 0});
    points_.push_back({(t.corner[0] + t.corner[1] + t.corner[2]) / 3.0, 0});
    if (state_.in_clusters)
      for (int k = 0; k < 3; ++k)
        points_.push_back(
            {t.corner[k] * (2.0 / 3) + (t.corner[(k + 1) % 3] + t.corner[(k + 2) % 3]) / 6, 0});
  }
}

bool MeasuredPolicy::spikes() {
  const double least = kSpike * state_.context.diagonal;
  std::uint32_t& hint = hint_[candidate().a];
  const double out = state_.sampled->largest({}, added_, points_, hint, {0, kNever});  // squared
  return out > least * least &&
         out > kSpikeRatio * kSpikeRatio *
                   state_.sampled->largest(removed_, added_, {}, hint, {0, kNever});
}

Quadric MeasuredPolicy::merged() { return state_.contraction.merged(candidate().a, candidate().b); }

/// Moves the candidate to where the original bounds it instead of the present mesh.
bool MeasuredPolicy::place_against_original() {
  describe_change();
  if (added_.empty()) return reject(statistics().rejected_topology);  // nothing would be left
  const CollapseEvaluator::Candidate& c = candidate();
  const std::vector<char>& border = state_.mesh().border;
  const bool free = border[c.a] == 0 && border[c.b] == 0;
  const auto place = free ? state_.optimiser->single().place_against_original(
                                removed_, added_, merged(), state_.context.cost.origin())
                          : std::optional<Vec3>();
  if (place && evaluator().place_against_original(*place, merged())) return true;
  return c.encloses || reject(statistics().rejected_no_position);
}

/// The exact test of a candidate placed against the original; tries other places until it holds, or
/// takes the one that the present mesh bounds. @return whether the cost is known.
bool MeasuredPolicy::certify(BucketQueue::Entry& e) {
  CollapseEvaluator::Candidate& c = candidate();
  Optimiser& optimiser = state_.optimiser->single();
  bool moved = false;
  for (int i = 0; i < kMeasuredPlaces; ++i) {
    if (optimiser.is_certified(removed_, c.position)) return !moved || measure(e);
    const auto place = optimiser.next_place();
    if (!place || *place == c.position || !evaluator().place_against_original(*place, merged()))
      break;
    moved = true;
  }
  if (!c.encloses) return reject(statistics().rejected_original);
  c.position = c.enclosing;
  c.against_original = false;
  return measure(e);
}

}  // namespace kaboum::bmesh
