#pragma once

#include <kaboum/bmesh/decimate.h>

#include <atomic>
#include <vector>

#include "error_bound_certificate.h"
#include "sampled_error.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// What the optimisers of one mesh know of its vertices.
struct VertexNotes {
  explicit VertexNotes(std::size_t vertices)
      : hint(vertices, 0), version(vertices, 0), movable(vertices, 1), flippable(vertices, 1) {}

  /// The star of v has changed. Safe to call from several threads.
  void disturb(std::uint32_t v) {
    std::atomic_ref(movable[v]).store(1, std::memory_order_relaxed);
    std::atomic_ref(flippable[v]).store(1, std::memory_order_relaxed);
    std::atomic_ref(version[v]).fetch_add(1, std::memory_order_relaxed);
  }

  std::vector<std::uint32_t> hint;     // where the original is near
  std::vector<std::uint32_t> version;  // raised when its star changes
  // Its star has changed since it was last tried in vain to move it, and since the last round of
  // flips.
  std::vector<char> movable, flippable;
};

/// What the steps of one optimiser change, measure, keep and count.
struct OptimiserContext {
  WorkingMesh& m_;
  VertexNotes& notes_;
  SampledError& sampled_;
  ErrorBoundCertificate* certificate_;  ///< null when there is no error bound
  const DecimateOptions& options_;
  DecimateStatistics& statistics_;
  std::vector<Step>* steps_;  ///< null when nobody asks for them
};

}  // namespace kaboum::bmesh
