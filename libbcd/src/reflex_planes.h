#pragma once

#include <cstdint>
#include <vector>

#include "cut_node.h"

namespace kaboum::bcd {

/// Planes that the reflex edges of a solid suggest for cuts: those of the faces
/// there, between these, and through two such edges.
class ReflexPlanes {
 public:
  /// To be called once, before anything else.
  void find(const SolidField& solid);

  /// Those of a piece's reflex edges that cut it, heaviest first.
  [[nodiscard]] std::vector<std::uint32_t> crossing(const CutNode& node) const;
  [[nodiscard]] const Plane& operator[](std::uint32_t i) const { return planes_[i].plane; }

 private:
  struct Weighted {
    Plane plane;
    double weight;
  };
  std::vector<Weighted> planes_;                // distinct
  std::vector<std::vector<std::uint32_t>> of_;  // triangle → planes_ entries
};

}  // namespace kaboum::bcd
