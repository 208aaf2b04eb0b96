// Which edges are contracted together with moves of the vertices around, and when.

#include "cluster_collapses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::bmesh {
namespace {

/// So many may fail by their deviation, and so many more for each that does not: on parts with many
/// sharp edges hardly any succeeds, and nothing is gained.
constexpr int kPatience = 120, kPatienceGained = 2;
/// So many are tried at once, far enough from each other.
constexpr std::size_t kBatch = 32;
/// Progress is told once for so many tries.
constexpr std::size_t kProgress = 256;

std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

}  // namespace

void ClusterCollapses::be_patient() { patience_ = kPatience; }

void ClusterCollapses::be_endlessly_patient() { patience_ = std::numeric_limits<int>::max() / 2; }

void ClusterCollapses::run(std::size_t target, double limit) {
  version_.resize(state_.mesh().position.size(), 0);
  ParallelOptimiser& optimiser = *state_.optimiser;
  const std::vector<Edge> edges = edges_by_cost(limit);
  std::vector<Edge> waiting, still, batch;
  std::size_t tried = 0;  // since progress was told
  for (std::size_t next = 0; state_.vertices() > target &&
                             (next < edges.size() || !waiting.empty()) &&
                             !state_.spent(kNoneMoves);) {
    const std::size_t most =
        optimiser.in_batches() ? std::min(kBatch, state_.vertices() - target) : 1;
    batch.clear();
    still.clear();
    const auto consider = [&](const Edge& e) {
      if (!may_succeed(e, limit)) return;
      (batch.size() < most && optimiser.claim({e.a, e.b}) ? batch : still).push_back(e);
    };
    for (const Edge& e : waiting) consider(e);
    for (; next < edges.size() && batch.size() < most && still.size() < kBatch; ++next)
      consider(edges[next]);
    waiting.swap(still);
    collapse_batch(batch, limit);
    if (out_of_patience()) return;
    tried += batch.size();
    if (state_.options.progress && tried >= kProgress) {
      state_.options.progress(state_.vertices());
      tried = 0;
    }
  }
}

/// Those that cost no more than the limit, at least.
std::vector<ClusterCollapses::Edge> ClusterCollapses::edges_by_cost(double limit) {
  const WorkingMesh& m = state_.mesh();
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < m.mesh.size(); ++t) {
    if (!m.mesh.alive(t)) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = m.mesh[t][k], b = m.mesh[t][(k + 1) % 3];
      if (a > b) continue;
      const double cost = state_.context.cost.least_key(state_.contraction.merged(a, b),
                                                        m.position[a], m.position[b]);
      if (!(cost > limit)) edges.push_back({cost, a, b});
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& x, const Edge& y) { return x.cost < y.cost; });
  return edges;
}

/// Whether it is still an edge, and has not failed where nothing has changed since.
bool ClusterCollapses::may_succeed(const Edge& e, double limit) {
  const Connectivity& mesh = state_.mesh().mesh;
  if (!mesh.used(e.a) || !mesh.used(e.b)) return false;
  bool adjacent = false;
  mesh.for_each_triangle(e.a, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : mesh[t]) adjacent = adjacent || w == e.b;
  });
  const auto failure = failures_.find(key(e.a, e.b));
  return adjacent && (failure == failures_.end() || !(failure->second.deviation > limit) ||
                      failure->second.version != version_[e.a] + version_[e.b]);
}

/// Contracts what has been claimed.
void ClusterCollapses::collapse_batch(std::span<const Edge> batch, double limit) {
  const std::span<const double> outcome = state_.optimiser->collapse_with_neighbours(limit);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Edge& e = batch[i];
    failures_[key(e.a, e.b)] = {version_[e.a] + version_[e.b], outcome[i]};
    if (outcome[i] > 0) {
      if (std::isfinite(outcome[i])) --patience_;
      continue;
    }
    patience_ += kPatienceGained;
    state_.contraction.contracted(e.a, e.b);
    for (const std::uint32_t v : state_.contraction.evaluator().neighbours(e.a)) ++version_[v];
    ++version_[e.a];
  }
}

}  // namespace kaboum::bmesh
