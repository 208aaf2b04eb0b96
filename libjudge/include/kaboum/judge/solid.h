#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/transform.h>

#include <array>
#include <cstdint>
#include <vector>

/// Collisions of exact meshes: to judge predicates by, none of whose code is in it. Own
/// kinematics, own trees of boxes; pairs of triangles are decided by CGAL's exact predicates.
namespace kaboum::judge {

/// A triangle mesh with a tree of boxes.
class Solid {
 public:
  explicit Solid(const geom::Mesh& mesh);

  /// True if two meshes have a point in common, or one is inside of the other. Vertices are rounded
  /// once when they are placed (2^-52 of the coordinates); from there on it is exact. Inside of an
  /// open mesh is nothing.
  [[nodiscard]] bool meets(const geom::Transform& at, const Solid& other,
                           const geom::Transform& other_at) const;

  /// True if some two triangles of meshes that do not meet are at most `reach` apart; rounded.
  [[nodiscard]] bool is_within(const geom::Transform& at, const Solid& other,
                               const geom::Transform& other_at, double reach) const;

  [[nodiscard]] bool closed() const { return closed_; }
  [[nodiscard]] std::size_t triangles() const { return triangles_.size(); }

 private:
  struct Node {
    geom::Vec3 center, half;
    std::uint32_t left = 0, right = 0;   ///< inner nodes
    std::uint32_t first = 0, count = 0;  ///< leaves: of triangles_
  };
  struct Pair;
  using Corners = std::array<geom::Vec3, 3>;

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  [[nodiscard]] Corners corners(std::uint32_t triangle) const;
  [[nodiscard]] bool holds(const geom::Vec3& point) const;
  /// Crossings of the segment, signed; false where one is not transversal.
  bool count_crossings(std::uint32_t node, const geom::Vec3& from, const geom::Vec3& to,
                       int& winding) const;

  std::vector<geom::Vec3> points_;
  std::vector<geom::Triangle> triangles_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> parts_;  ///< a vertex of each connected part
  double size_ = 0;
  bool closed_ = false;
};

}  // namespace kaboum::judge
