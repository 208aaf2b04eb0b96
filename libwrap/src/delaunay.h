#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::wrap {

using geom::Vec3;

/// Delaunay tetrahedra of the corners of a box and points inside it, added one at a time.
///
/// Incremental insertion [bowyer1981]: the tetrahedra with the new point strictly inside their
/// circumspheres are replaced by the cone from it over their boundary. Both predicates are exact,
/// so that the tetrahedra fill the box without overlapping, whatever the points are:
/// docs/algorithms/wrapping.md has the proof.
class Delaunay {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// A tetrahedron with det(v1 − v0, v2 − v0, v3 − v0) > 0.
  struct Cell {
    std::array<std::uint32_t, 4> vertex;
    std::array<std::uint32_t, 4> next;  ///< across the facet opposite each vertex; kNone: the box
    [[nodiscard]] bool gone() const { return vertex[0] == kNone; }
    [[nodiscard]] bool has(std::uint32_t v) const {
      return vertex[0] == v || vertex[1] == v || vertex[2] == v || vertex[3] == v;
    }
  };

  /// Corners of the facet opposite vertex i, counter-clockwise seen from outside the tetrahedron.
  static constexpr std::array<std::array<std::uint8_t, 3>, 4> kFacet{
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

  /// @pre the box has a volume
  explicit Delaunay(const geom::Box3& box);

  [[nodiscard]] std::size_t point_count() const { return points_.size(); }
  [[nodiscard]] const Vec3& point(std::uint32_t v) const { return points_[v]; }
  /// Places of tetrahedra: those in use and those that are gone.
  [[nodiscard]] std::size_t cell_count() const { return cells_.size(); }
  [[nodiscard]] const Cell& cell(std::uint32_t c) const { return cells_[c]; }
  /// A tetrahedron at the vertex.
  [[nodiscard]] std::uint32_t cell_at(std::uint32_t v) const { return at_[v]; }

  /// Tetrahedra with the vertex, in a fixed order.
  void cells_round(std::uint32_t v, std::vector<std::uint32_t>& cells) const;

  /// Adds a point.
  /// @param near  a tetrahedron, best one with the point inside its circumsphere
  /// @param apart  least distance that the point must have from others, rounded [length]
  /// @return the new vertex; kNone where the point is nearer than `apart` to another vertex, or
  ///   not inside the box: then nothing is changed
  std::uint32_t insert(const Vec3& p, std::uint32_t near, double apart);
  /// Puts a point between two vertices that share an edge: each tetrahedron at the edge becomes
  /// two, the one with `from` keeps its place. They need not be Delaunay ones any more, so that no
  /// point may be inserted afterwards.
  /// @param ring  the tetrahedra at the edge
  /// @param made  the others of the two, in the same order
  /// @return the new vertex; kNone where some tetrahedron would be turned over: then nothing is
  ///   changed
  std::uint32_t split(std::uint32_t from, std::uint32_t to, const Vec3& p,
                      std::span<const std::uint32_t> ring, std::vector<std::uint32_t>& made);
  /// Tetrahedra that the last insertion made.
  [[nodiscard]] std::span<const std::uint32_t> made() const { return made_; }

 private:
  struct Facet {
    std::array<std::uint32_t, 3> corner;  ///< counter-clockwise seen from outside the hole
    std::uint32_t beyond;
    std::uint32_t cell;  ///< made upon it
  };

  [[nodiscard]] bool conflicts(std::uint32_t c, const Vec3& p) const;
  [[nodiscard]] std::uint32_t locate(const Vec3& p, std::uint32_t from) const;
  /// Fills hole_ and rim_.
  void find_hole(const Vec3& p, std::uint32_t start);
  std::uint32_t new_cell();
  void join_made();

  std::vector<Vec3> points_;
  std::vector<std::uint32_t> at_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> free_, made_, hole_;
  std::vector<Facet> rim_;
  std::vector<std::uint32_t> mark_;  ///< per cell: twice the round it was looked at in, +1: hole
  std::uint32_t round_ = 0;
  struct Edge {
    std::uint64_t key;
    std::uint32_t cell, side;
  };
  std::vector<Edge> table_;
};

}  // namespace kaboum::wrap
