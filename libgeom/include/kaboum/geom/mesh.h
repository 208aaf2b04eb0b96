#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace kaboum::geom {

/// A point or vector in the mesh's unit of length.
using Vec3 = Eigen::Vector3d;

/// Vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// Indexed triangle mesh; double coordinates. Nothing is assumed of it: it may be open,
/// non-manifold, self-intersecting, or hold degenerate triangles and unreferenced vertices.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

/// Axis-aligned box; empty when min > max.
struct Box3 {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  void extend(const Box3& b) {
    min = min.cwiseMin(b.min);
    max = max.cwiseMax(b.max);
  }
  [[nodiscard]] bool empty() const { return !(min.array() <= max.array()).all(); }
  [[nodiscard]] Vec3 center() const { return 0.5 * min + 0.5 * max; }
  /// Length of the diagonal; 0 when empty.
  [[nodiscard]] double diagonal() const { return empty() ? 0.0 : (max - min).norm(); }
};

/// Box of the vertices that triangles refer to.
/// @pre indices are in range.
Box3 bounding_box(const Mesh& mesh);

/// Signed volume, ⅓ Σ over triangles of the signed tetrahedra with the box's centre. Rounded
/// arithmetic: for reports and orientation guesses, never for a guarantee. [length³]
double signed_volume(const Mesh& mesh);

/// Sum of the triangles' areas. [length²]
double area(const Mesh& mesh);

/// Checks that every index is in range and every referenced coordinate is finite.
/// @throws Error{InvalidInput} naming the first offending triangle or vertex.
void require_valid(const Mesh& mesh);

}  // namespace kaboum::geom
