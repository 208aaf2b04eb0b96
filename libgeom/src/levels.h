#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "chains.h"

namespace kaboum::geom {

/// Winding numbers in front of a triangle and behind, and the regions between.
struct Probe {
  std::uint32_t triangle = ~0U;
  Vec3 in_front, behind;
  int front = 0, back = 0;
  std::vector<std::pair<std::uint32_t, bool>> regions;  // oriented as the triangle?
};

/// Chains without those levels that are closed by themselves, and where some still wind both ways.
struct Levels {
  Chains chains;
  std::vector<Probe> doubts;  ///< with winding numbers of both signs
};

/// Chains of several patches are told apart by the winding numbers on both sides of their regions:
/// what is closed within one level of a chain is split off; the rest of the chain, closed as well,
/// stays together.
/// @param chains   of the mesh.
/// @param winding  of the mesh, with the hierarchy.
Levels split_levels(const Mesh& mesh, std::span<const EdgeUse> uses, Chains chains, const Bvh& bvh,
                    const WindingNumber& winding);

}  // namespace kaboum::geom
