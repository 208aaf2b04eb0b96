#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <vector>

namespace kaboum::geom {

struct SolidMeshMaker;

/// A mesh whose solid is defined: welded, without unused vertices, every triangle with three
/// different corners. Where it is closed its triangles form a closed chain, and its solid is the
/// closure of the points that the chain winds about at least once; where it is open, only its
/// triangles are meant. Made by prepare() and close_holes() alone, so a function that takes one
/// need not ask. docs/algorithms/preparation.md says which solid is meant. The default has no
/// triangle.
class SolidMesh {
 public:
  SolidMesh() = default;

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  /// Per vertex: 1 if it lies on an edge whose triangles do not cancel, else 0. All 0: closed.
  [[nodiscard]] const std::vector<char>& border() const { return border_; }
  /// The triangles form a closed chain.
  [[nodiscard]] bool closed() const { return closed_; }
  /// Triangles that fill holes of the input: the mesh's last ones.
  [[nodiscard]] std::size_t filled_triangles() const { return filled_triangles_; }

 private:
  friend struct SolidMeshMaker;

  Mesh mesh_;
  std::vector<char> border_;
  bool closed_ = true;
  std::size_t filled_triangles_ = 0;
};

/// The same where the mesh is closed. Otherwise fill_holes closes it; vertices and triangles that
/// fill holes come last.
SolidMesh close_holes(const SolidMesh& open);

}  // namespace kaboum::geom
