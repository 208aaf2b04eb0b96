#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/topology.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::geom {

/// What is inside out, and what cannot be told.
struct Judgement {
  /// A place where a part is inside out in spite of the turns.
  struct Place {
    std::uint32_t triangle;
    Vec3 at;
    bool at_wall;  ///< of bodies that share a wall and could not be told apart
  };

  std::vector<char> reverse;              ///< per triangle: to be turned
  std::vector<std::uint32_t> inside_out;  ///< a triangle of each shell turned for its own sake
  std::size_t cavities_reversed = 0;      ///< shells turned along with those
  std::size_t cavities = 0;               ///< shells that stay oriented inwards
  std::optional<Place> left;              ///< the first place that stays inside out
};

/// Divides the closed part of a mesh into shells and finds those that are inside out;
/// docs/algorithms/preparation.md says how, and proves what follows.
/// @param was_open  per triangle: 1 where it is of a part that was open before its holes were
///   filled, or fills one, else 0; empty: all 0. Such parts are judged apart from the others and
///   are never cavities.
/// @pre welded; no opposite coincident triangles but those that fill holes.
Judgement judge_shells(const Mesh& mesh, std::span<const EdgeUse> uses,
                       std::span<const std::uint32_t> was_open = {});

}  // namespace kaboum::geom
