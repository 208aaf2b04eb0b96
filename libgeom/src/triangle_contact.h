#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>

namespace kaboum::geom {

inline bool overlap(const Box3& a, const Box3& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

/// Whether two triangles without repeated corners meet in anything but a corner or an edge that
/// both have; exact. Triangles without area lie on their neighbours' edges and are left to those.
bool meet_improperly(const Mesh& mesh, std::uint32_t t, std::uint32_t u);

enum class Crossing { None, Proper, Unclear };

/// Whether the segment from p to q passes through the inside of the triangle; exact.
Crossing crossing(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace kaboum::geom
