// Optimisation by several threads, in batches of steps that commute.

#include <kaboum/base/parallel.h>

#include "optimise_in_parallel.h"

#include <algorithm>

#include "regions.h"

namespace kaboum::bmesh {
namespace {

/// Vertices moved in one batch.
constexpr std::size_t kMoves = 64;

}  // namespace

ParallelOptimiser::Worker::Worker(ParallelOptimiser& of)
    : optimiser({of.m_, of.notes_, of.sampled_, nullptr, of.options_, statistics,
                 of.steps_ != nullptr ? &steps : nullptr},
                of.solid_, of.original_) {
  optimiser.set_dense(of.dense_);
}

ParallelOptimiser::ParallelOptimiser(WorkingMesh& mesh, SampledError& sampled,
                                     ReferenceSolid* solid, const geom::Mesh& original,
                                     ErrorBoundCertificate* certificate,
                                     const DecimateOptions& options, DecimateStatistics& statistics,
                                     std::vector<Step>* steps, bool dense, Work* work)
    : m_(mesh),
      notes_(mesh.position.size()),
      sampled_(sampled),
      solid_(solid),
      original_(original),
      certificate_(certificate),
      options_(options),
      statistics_(statistics),
      steps_(steps),
      dense_(dense),
      work_(work),
      single_({mesh, notes_, sampled, certificate, options, statistics, steps}, solid, original),
      workers_([this] { return Worker(*this); }),
      mark_(mesh.position.size(), 0) {
  single_.set_dense(dense);
}

/// Calls task(optimiser, i) for all i < tasks, whose steps commute.
template <class Task>
void ParallelOptimiser::run(std::size_t tasks, Task&& task) {
  if (tasks < 2) {
    for (std::size_t i = 0; i < tasks; ++i) task(single_, i);
    return;
  }
  const bool recorded = steps_ != nullptr;
  taken_.resize(std::max(taken_.size(), recorded ? tasks : 0));
  const auto each = [&](std::size_t i) {
    Worker& worker = workers_.local();
    worker.steps.clear();
    task(worker.optimiser, i);
    if (recorded) taken_[i].assign(worker.steps.begin(), worker.steps.end());
  };
  parallel_for(std::size_t{0}, tasks, each, {.alone = true});
  for (Worker& worker : workers_) {
    add(statistics_, worker.statistics);
    worker.statistics = {};
  }
  if (!recorded) return;
  for (std::size_t i = 0; i < tasks; ++i)
    steps_->insert(steps_->end(), taken_[i].begin(), taken_[i].end());
}

void ParallelOptimiser::begin_batch() {
  batch_.clear();
  ++mark_value_;
}

/// Marks the vertices that are moved and their neighbours, unless one that is moved is marked.
bool ParallelOptimiser::claim(std::span<const std::uint32_t> moved) {
  if (std::any_of(moved.begin(), moved.end(),
                  [&](std::uint32_t v) { return mark_[v] == mark_value_; }))
    return false;
  for (const std::uint32_t v : moved) {
    mark_[v] = mark_value_;
    m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t) {
      for (const std::uint32_t w : m_.mesh[t]) mark_[w] = mark_value_;
    });
  }
  return true;
}

bool ParallelOptimiser::claim(Edge edge) {
  moved_.clear();
  for (const std::uint32_t v : {edge.a, edge.b})
    m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t) {
      for (const std::uint32_t w : m_.mesh[t]) moved_.push_back(w);
    });
  if (!claim(moved_)) return false;
  batch_.push_back(edge);
  return true;
}

std::span<const double> ParallelOptimiser::collapse_with_neighbours(double limit) {
  outcome_.resize(batch_.size());
  run(batch_.size(), [&](Optimiser& optimiser, std::size_t i) {
    outcome_[i] = optimiser.collapse_with_neighbours(batch_[i].a, batch_[i].b, limit);
  });
  begin_batch();
  return outcome_;
}

/// Vertices come from next(), until it returns kNone, and are moved in this order, but for those
/// that wait for a neighbour.
void ParallelOptimiser::pull_back_each(const std::function<std::uint32_t()>& next,
                                       const std::function<void(std::uint32_t)>& moved) {
  std::vector<std::uint32_t> waiting, batch, still;
  std::vector<char> moves;
  const std::size_t most = in_batches() ? kMoves : 1;
  bool more = true;
  while ((more || !waiting.empty()) && goes_on()) {
    begin_batch();
    batch.clear();
    still.clear();
    const auto consider = [&](std::uint32_t v) {
      if (!m_.mesh.used(v) || notes_.movable[v] == 0) return;
      (batch.size() < most && claim(std::span(&v, 1)) ? batch : still).push_back(v);
    };
    for (const std::uint32_t v : waiting) consider(v);
    while (more && batch.size() < most && still.size() < kMoves) {
      const std::uint32_t v = next();
      more = v != Connectivity::kNone;
      if (more) consider(v);
    }
    moves.assign(batch.size(), 0);
    run(batch.size(), [&](Optimiser& optimiser, std::size_t i) {
      moves[i] = static_cast<char>(optimiser.pull_back(batch[i]));
    });
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (moves[i] != 0) moved(batch[i]);
    waiting.swap(still);
  }
  begin_batch();
}

std::size_t ParallelOptimiser::pass() {
  std::size_t steps = 0;
  const auto vertices = static_cast<std::uint32_t>(m_.position.size());
  pull_back_each(
      [vertices, v = std::uint32_t{0}]() mutable {
        return v < vertices ? v++ : Connectivity::kNone;
      },
      [&](std::uint32_t) { ++steps; });
  for (std::uint32_t t = 0; t < m_.mesh.size() && goes_on(); ++t) {
    for (std::uint32_t k = 0; k < 3 && m_.mesh.alive(t); ++k) {
      const std::uint32_t a = m_.mesh[t][k], b = m_.mesh[t][(k + 1) % 3];
      if (a < b && notes_.flippable[a] != 0 && notes_.flippable[b] != 0 && single_.flip(a, b))
        ++steps;
    }
  }
  // What flips have changed is tried again after the next moves.
  std::fill(notes_.flippable.begin(), notes_.flippable.end(), 0);
  return steps;
}

}  // namespace kaboum::bmesh
