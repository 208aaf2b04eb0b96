#pragma once

#include <kaboum/bmesh/decimate.h>

#include <optional>
#include <vector>

#include "optimiser_context.h"
#include "region_snapshot.h"
#include "star_step.h"

namespace kaboum::bmesh {

class Optimiser;

/// Contractions that move the vertices around with them.
class NeighbourCollapse : private OptimiserContext {
 public:
  /// What the context refers to, the optimiser and the step must outlive this object and not move.
  NeighbourCollapse(const OptimiserContext& context, Optimiser& optimiser, StarStep& step);

  /// Optimiser::collapse_with_neighbours.
  double collapse(std::uint32_t a, std::uint32_t b, double limit);

 private:
  void neighbours(std::uint32_t v, std::vector<std::uint32_t>& out);
  void relax_vertex(std::size_t i, double scale, double penalty, double share, bool hand_over);
  void follow(std::size_t i, double close, std::uint32_t& hint);
  double star_largest(std::uint32_t v, double limit);
  double region_largest(double least, double most);
  std::optional<Vec3> find_position(std::uint32_t a, std::uint32_t b, const Vec3& wish);
  double trial_collapse(std::uint32_t a, std::uint32_t b, double limit);
  double settle(double limit);
  bool satisfies_link_condition(std::uint32_t a, std::uint32_t b);
  bool gather_edge(std::uint32_t a, std::uint32_t b, const Vec3& to);
  void contract(std::uint32_t a, std::uint32_t b, const Vec3& to);

  Optimiser& optimiser_;
  StarStep& step_;
  RegionSnapshot before_;

  std::vector<std::uint32_t> mark_;  // of vertices
  std::uint32_t mark_value_ = 0;
  std::vector<std::uint32_t> around_;  // vertices that move with a contraction, it first
  std::vector<Vec3> target_;           // of these
  // For each of these, triangles of the original that were nearest to points of its star.
  std::vector<std::vector<std::uint32_t>> near_;
  std::vector<std::uint32_t> alive_;
};

}  // namespace kaboum::bmesh
