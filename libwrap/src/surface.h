#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/self_intersection.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd.h"
#include "obstacle.h"

namespace kaboum::wrap {

/// A closed surface that changes without passing the obstacle, or meeting itself.
///
/// Each change is the sum of tetrahedra with their borders. It is made only where the obstacle is
/// clear of all of them, and the new triangles, exactly, meet each other and those that stay in
/// common corners and edges only; it is refused otherwise. So what begins as a manifold that does
/// not meet itself remains one.
class Surface {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  Surface(geom::Mesh mesh, const Obstacle& obstacle, bool float32);

  [[nodiscard]] std::size_t vertex_count() const { return points_.size(); }
  [[nodiscard]] const Vec3& point(std::uint32_t v) const { return points_[v]; }
  [[nodiscard]] const geom::Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] bool gone(std::uint32_t t) const { return triangles_[t][0] == kNone; }
  /// Triangles round a vertex, in no order; none of a vertex that is gone.
  [[nodiscard]] std::span<const std::uint32_t> star(std::uint32_t v) const { return stars_[v]; }
  /// Vertices that share an edge with v, each once, ascending.
  [[nodiscard]] std::vector<std::uint32_t> neighbours(std::uint32_t v) const;

  /// The point as it may be stored.
  [[nodiscard]] Vec3 representable(const Vec3& p) const;

  /// Moves a vertex. @pre p is representable
  bool move(std::uint32_t v, const Vec3& p);
  /// Puts a vertex onto an edge. @return it; kNone if refused. @pre p is representable
  std::uint32_t split(std::uint32_t a, std::uint32_t b, const Vec3& p);
  /// Contracts the edge from a to b into a, at p. Where a and b have other common neighbours than
  /// the edge's triangles, it is refused. @pre p is representable
  bool contract(std::uint32_t a, std::uint32_t b, const Vec3& p);

  /// What is left, in the order of the vertices.
  [[nodiscard]] geom::Mesh mesh() const;

 private:
  [[nodiscard]] bool has(std::uint32_t t, std::uint32_t v) const;
  /// Whether the cone from p over the triangle can be added.
  void add_cone(std::uint32_t t, const Vec3& p, std::vector<Tetrahedron>& cones) const;
  void leave(std::uint32_t v, std::uint32_t t);

  /// A triangle as it would be.
  struct Change {
    std::uint32_t triangle;  ///< whose place it takes; beyond the last one: a new place
    std::uint32_t near;      ///< a triangle that is there already
    geom::NamedTriangle to;
  };
  /// Whether the changes, instead of the triangles of `removed` and those that change, leave a
  /// surface that does not meet itself.
  bool apart(std::span<const Change> changes, std::span<const std::uint32_t> removed);
  void note(std::span<const Change> changes);
  /// The triangle with `from` called `to`, which is at p.
  void change(std::uint32_t t, std::uint32_t from, std::uint32_t to, const Vec3& p);
  void build_crowd();

  std::vector<Vec3> points_;
  std::vector<geom::Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> stars_;
  const Obstacle& obstacle_;
  bool float32_;
  std::vector<Tetrahedron> cones_;
  std::vector<Change> changes_;
  std::vector<geom::Box3> boxes_;  ///< of the changes that were looked at last
  Crowd crowd_;
  std::vector<std::uint32_t> mark_;  ///< per triangle: the check that leaves it out
  std::uint32_t check_ = 0;
};

}  // namespace kaboum::wrap
