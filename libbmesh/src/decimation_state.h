#pragma once

#include <optional>
#include <vector>

#include "contraction.h"
#include "error_bound_certificate.h"
#include "optimise_in_parallel.h"
#include "reference_solid.h"
#include "regions.h"
#include "sampled_error.h"
#include "schedule.h"

namespace kaboum::bmesh {

/// What the parts of a decimation share: the mesh at hand, and what it is measured and certified
/// by.
struct DecimationState {
  /// References must outlive this object. @param original  what `start` was made of, whatever has
  /// happened to it since.
  DecimationState(const Context& run, const geom::Mesh& made_of, PartialMesh start,
                  std::optional<ReferenceSolid>& of_bound, std::vector<Step>* record,
                  const std::optional<RisingBound>& rising);
  DecimationState(const DecimationState&) = delete;
  DecimationState& operator=(const DecimationState&) = delete;
  ~DecimationState() = default;

  /// Whether this share of the work allowed has been done, and something is left undone for it.
  [[nodiscard]] bool spent(double share);

  /// Begins to follow how far the mesh is from the original.
  void start_measuring();
  /// Begins to move vertices back. @pre measured
  void start_optimising();

  [[nodiscard]] WorkingMesh& mesh() { return contraction.mesh(); }
  [[nodiscard]] std::size_t vertices() const { return contraction.vertices(); }
  [[nodiscard]] ReferenceSolid* solid() { return reference ? &*reference : nullptr; }
  [[nodiscard]] ErrorBoundCertificate* certificate() { return carried ? &*carried : nullptr; }

  const Context& context;
  const DecimateOptions& options;
  const geom::Mesh& original;
  const geom::Mesh* bound;                   ///< what steps must enclose, or be enclosed by
  std::optional<ReferenceSolid>& reference;  ///< of bound
  std::vector<Step>* steps;
  std::optional<double> epsilon;  ///< that steps keep
  double most_epsilon;            ///< to which that rises; 0: it does not
  double alone;                   ///< RisingBound::alone
  bool in_clusters;               ///< contractions may move the vertices around
  Contraction contraction;
  std::optional<ErrorBoundCertificate> carried;  ///< of epsilon
  std::optional<SampledError> sampled;
  std::optional<ParallelOptimiser> optimiser;
  bool measuring = false;    ///< costs are measured distances
  bool hurries = false;      ///< no more, nor are vertices pulled back: too much work is done
  bool ended_early = false;  ///< something was left undone for that
  bool bounded = false;      ///< some candidate failed for epsilon alone
  double reached = 0;        ///< largest measured cost of a contraction [length]
};

}  // namespace kaboum::bmesh
