#pragma once

#include <cstdint>
#include <vector>

#include "change.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// The triangles around an edge that may be contracted, or around a vertex that
/// may move.
class EdgeStar {
 public:
  struct StarTriangle {
    std::uint32_t index;
    std::uint32_t corner;  // of the moved vertex
    bool at_b;             // touches b and not a
    bool vanishes;         // touches both
  };

  /// The mesh must outlive this object.
  explicit EdgeStar(const WorkingMesh& mesh);

  /// Fills triangles with the star of the edge (a, b), or of v. There is no rim
  /// then.
  void gather(std::uint32_t a, std::uint32_t b);
  void gather(std::uint32_t v);

  /// Fills rim with the triangles across the star's boundary.
  void gather_rim();

  /// The link condition: the neighbours common to a and b are the corners
  /// opposite their edge, and no two triangles would come to coincide.
  /// @pre gather(a, b)
  [[nodiscard]] bool keeps_topology(std::uint32_t a, std::uint32_t b);

  /// The triangles that go, and those that come when the vertex goes to
  /// `position`.
  void describe(const Vec3& position, std::vector<std::uint32_t>& removed,
                std::vector<NewTriangle>& added) const;

  /// The vertices that share a triangle with v; valid until the next call of
  /// anything.
  const std::vector<std::uint32_t>& neighbours(std::uint32_t v);

  std::vector<StarTriangle> triangles;
  std::vector<std::uint32_t> rim;

 private:
  const WorkingMesh& m_;
  std::vector<std::uint32_t> mark_, neighbours_;
  std::uint32_t mark_value_ = 0;
};

}  // namespace kaboum::bmesh
