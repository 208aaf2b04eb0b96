#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <functional>
#include <span>

#include "optimise.h"
#include "work.h"

namespace kaboum::bmesh {

/// Optimisation by several threads: steps are taken in batches, each in a region of its own, so
/// that the result does not depend on how many threads there are, or which is first.
///
/// A step moves some vertices, and reads the stars of those only. Two steps commute when no vertex
/// that one moves is, or neighbours, one that the other moves: they have then no triangle in
/// common.
class ParallelOptimiser {
 public:
  struct Edge {
    std::uint32_t a, b;
  };

  /// As of Optimiser; `steps` may be null. Rounds end early when so much work is done that no
  /// vertex is to be moved any more; `work` may be null.
  ParallelOptimiser(WorkingMesh& mesh, SampledError& sampled, ReferenceSolid* solid,
                    const geom::Mesh& original, ErrorBoundCertificate* certificate,
                    const DecimateOptions& options, DecimateStatistics& statistics,
                    std::vector<Step>* steps, bool dense, Work* work = nullptr);
  ParallelOptimiser(const ParallelOptimiser&) = delete;
  ParallelOptimiser& operator=(const ParallelOptimiser&) = delete;
  ~ParallelOptimiser() = default;

  /// For one step at a time.
  Optimiser& single() { return single_; }

  /// Of the edge's ends' stars: the same only if nothing has changed in them.
  [[nodiscard]] std::uint32_t version(std::uint32_t a, std::uint32_t b) const {
    return notes_.version[a] + notes_.version[b];
  }

  /// One round over all vertices, then all edges. @return steps taken.
  std::size_t pass();

  /// Tries to move these vertices, where they are still used; calls moved(v) for each that has.
  template <class Moved>
  void pull_back(std::span<const std::uint32_t> vertices, Moved&& moved) {
    pull_back_each(
        [vertices, i = std::size_t{0}]() mutable {
          return i < vertices.size() ? vertices[i++] : Connectivity::kNone;
        },
        moved);
  }

  /// Whether steps are taken several at a time: an error bound is carried over all of the mesh, and
  /// needs one after the other.
  [[nodiscard]] bool in_batches() const { return certificate_ == nullptr; }

  /// Adds the edge to the batch at hand, if its contraction commutes with the others of the batch.
  bool claim(Edge edge);

  /// Contracts the batch's edges together with moves, as Optimiser::collapse does, and begins
  /// another batch. @return what that returns for each, in the order of the claims.
  std::span<const double> collapse_with_neighbours(double limit);

 private:
  /// An optimiser for one thread.
  struct Worker {
    explicit Worker(ParallelOptimiser& of);
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    ~Worker() = default;
    DecimateStatistics statistics;
    std::vector<Step> steps;
    Optimiser optimiser;
  };

  [[nodiscard]] bool goes_on() const { return work_ == nullptr || !work_->spent(kNoneMoves); }
  bool claim(std::span<const std::uint32_t> moved);
  void begin_batch();
  template <class Task>
  void run(std::size_t tasks, Task&& task);
  void pull_back_each(const std::function<std::uint32_t()>& next,
                      const std::function<void(std::uint32_t)>& moved);

  WorkingMesh& m_;
  VertexNotes notes_;
  SampledError& sampled_;
  ReferenceSolid* solid_;
  const geom::Mesh& original_;
  ErrorBoundCertificate* certificate_;
  const DecimateOptions& options_;
  DecimateStatistics& statistics_;
  std::vector<Step>* steps_;
  bool dense_;
  Work* work_;
  Optimiser single_;
  tbb::enumerable_thread_specific<Worker> workers_;

  std::vector<Edge> batch_;
  std::vector<double> outcome_;           // of the batch
  std::vector<std::vector<Step>> taken_;  // steps, by task
  std::vector<std::uint32_t> mark_;       // of a vertex: of the batch that moves it or a neighbour
  std::uint32_t mark_value_ = 1;
  std::vector<std::uint32_t> moved_;
};

}  // namespace kaboum::bmesh
