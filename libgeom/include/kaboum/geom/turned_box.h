#pragma once

#include <kaboum/geom/transform.h>

namespace kaboum::geom {

/// A box of something in its frame, and one round it where it is: what is in boxes that are apart
/// need not be asked about.
struct TurnedBox {
  Box3 own, placed;

  void put(const Transform& pose) {
    if (own.empty()) return;
    const Vec3 center = pose * own.center();
    const Vec3 half = pose.linear.cwiseAbs() * (0.5 * (own.max - own.min));
    const Vec3 more = half + 1e-9 * (center.cwiseAbs() + half);
    placed = {center - more, center + more};
  }

  [[nodiscard]] bool meets(const TurnedBox& other) const {
    return (placed.min.array() <= other.placed.max.array()).all() &&
           (other.placed.min.array() <= placed.max.array()).all();
  }
};

}  // namespace kaboum::geom
