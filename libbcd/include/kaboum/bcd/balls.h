#pragma once

#include <kaboum/bcd/cover.h>
#include <kaboum/geom/solid_mesh.h>

#include <optional>
#include <vector>

namespace kaboum::bcd {

/// Request for find_balls.
struct BallOptions : SearchRun {
  std::optional<std::size_t> max_bodies;
  Effort effort = Effort::Normal;
  std::vector<geom::Vec3> held;  ///< points of the solid that the balls are to hold as well
};

/// Searches for few balls whose union contains the input's solid and every triangle of it. Centres
/// and radii are float32 numbers.
///
/// A ball about c of radius ε − s(c) has no point farther than ε from the solid, s being the signed
/// distance to its surface, negative inside: those about the medial axis are the largest ones.
/// Among some thousand of them few are chosen that hold sampled points, by a local search with
/// weights [gao2015]. Points of triangles that no ball holds are added until there are none. With
/// `max_bodies` ε is the least for which so many are found. docs/algorithms/sphere-covers.md.
///
/// No claim that they cover: certify::certify_set decides that. The distances are certified.
///
/// @pre epsilon or max_bodies is given
/// @throws Error{InvalidArgument} on contradictory options; Error{LimitReached} where epsilon would
///   take more balls than can be searched for
CoverCandidate find_balls(const geom::SolidMesh& input, const BallOptions& options);

}  // namespace kaboum::bcd
