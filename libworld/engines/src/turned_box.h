#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/transform.h>

namespace kaboum::engines {

/// A box of something in its frame, and one round it where it is: what is in boxes that are apart
/// need not be asked about.
struct TurnedBox {
  geom::Box3 own, placed;

  void put(const geom::Transform& pose) {
    if (own.empty()) return;
    const geom::Vec3 center = pose * own.center();
    const geom::Vec3 half = pose.linear.cwiseAbs() * (0.5 * (own.max - own.min));
    const geom::Vec3 more = half + 1e-9 * (center.cwiseAbs() + half);
    placed = {center - more, center + more};
  }

  [[nodiscard]] bool meets(const TurnedBox& other) const {
    return (placed.min.array() <= other.placed.max.array()).all() &&
           (other.placed.min.array() <= placed.max.array()).all();
  }
};

}  // namespace kaboum::engines
