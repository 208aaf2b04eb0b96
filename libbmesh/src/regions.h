#pragma once

#include "contraction.h"

namespace kaboum::bmesh {

/// Adds what was counted.
inline void add(DecimateStatistics& sum, const DecimateStatistics& s) {
  sum.contractions += s.contractions;
  sum.moves += s.moves;
  sum.pull_backs += s.pull_backs;
  sum.flips += s.flips;
  sum.placements += s.placements;
  sum.predicates += s.predicates;
  sum.exact_fallbacks += s.exact_fallbacks;
  sum.rejected_topology += s.rejected_topology;
  sum.rejected_no_position += s.rejected_no_position;
  sum.rejected_predicate += s.rejected_predicate;
  sum.rejected_fold += s.rejected_fold;
  sum.rejected_distance += s.rejected_distance;
  sum.rejected_spike += s.rejected_spike;
  sum.rejected_original += s.rejected_original;
}

/// A mesh between the input and the result.
struct PartialMesh {
  PartialMesh(const geom::Mesh& mesh, std::vector<char> may_not_move,
              std::vector<Quadric> quadrics);

  std::vector<Vec3> position;
  std::vector<char> border;
  std::vector<Quadric> quadric;
  std::vector<std::uint32_t> vertex;  // its number in the input
  std::vector<geom::Triangle> triangles;
  std::vector<std::uint32_t> triangle;  // its number in the input
};

/// Contracts the edges of a large mesh region by region, in rounds, down to somewhat more than
/// `target` vertices; leaves a small one as it is.
///
/// A round cuts the mesh into regions of some thousand vertices along a space-filling curve, and
/// contracts in each what costs no more than a common limit and has its whole star in the region.
/// Such contractions in different regions commute: no triangle of one star is in the other. The
/// next round, with a higher limit, cuts elsewhere. So the result does not depend on the number of
/// threads, only on the mesh; and a region fits into a processor's own memory.
///
/// Vertices come out in the order of the curve, triangles in that of the input.
///
/// @param solid  may be null. @param steps  receives the steps, in the input's numbers, when not
/// null.
void contract_in_regions(const Context& context, PartialMesh& mesh, std::size_t target,
                         ReferenceSolid* solid, std::vector<Step>* steps,
                         DecimateStatistics& statistics);

}  // namespace kaboum::bmesh
