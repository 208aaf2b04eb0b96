#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/winding.h>

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "chains.h"

namespace kaboum::geom {

/// A mesh's chains with what is in them.
struct Shells {
  const Mesh& mesh;
  Chains chains;
  std::vector<std::vector<std::uint32_t>> members = {};  ///< per chain: triangles, ascending
  std::vector<Box3> box = {};                            ///< per chain
};

/// Where a shell lies with respect to the others.
struct Position {
  std::map<std::uint32_t, int> winding;  ///< of each shell round this one, where not 0
  std::set<std::uint32_t> unclear;       ///< shells that it meets in more than corners and edges

  [[nodiscard]] int of(std::uint32_t shell) const {
    const auto at = winding.find(shell);
    return at == winding.end() ? 0 : at->second;
  }
  [[nodiscard]] bool clear(std::uint32_t shell) const { return !unclear.contains(shell); }
};

/// Positions of shells, each found when it is asked for.
class ShellPositions {
 public:
  ShellPositions(const Shells& shells, const Bvh& bvh, const WindingNumber& winding)
      : shells_(shells), bvh_(bvh), winding_(winding) {}

  const Position& operator()(std::uint32_t c) {
    const auto [at, fresh] = positions_.try_emplace(c);
    if (fresh) at->second = find(c);
    return at->second;
  }

 private:
  [[nodiscard]] Position find(std::uint32_t c) const;

  const Shells& shells_;
  const Bvh& bvh_;
  const WindingNumber& winding_;
  std::map<std::uint32_t, Position> positions_;
};

}  // namespace kaboum::geom
