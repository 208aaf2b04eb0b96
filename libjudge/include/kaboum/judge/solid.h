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

  /// How deep one of two meshes that meet is in the other: the largest distance of a point of its
  /// triangles that is inside of the other mesh from that one's triangles; rounded. No shift by
  /// less parts the two. The points are corners and others between, no farther than `step` apart,
  /// so a point may be deeper by `step`; 0 where none of them is inside.
  /// @pre step > 0
  [[nodiscard]] double depth(const geom::Transform& at, const Solid& other,
                             const geom::Transform& other_at, double step) const;

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
  /// Of the triangles below a node from a point, or `most` if that is less.
  [[nodiscard]] double square_distance(std::uint32_t node, const geom::Vec3& point,
                                       double most) const;
  /// The deepest of this mesh's points in the other one, which `turn` and `shift` lead to; `best`
  /// if it is not deeper.
  [[nodiscard]] double deepest_in(const Solid& other, const Eigen::Matrix3d& turn,
                                  const geom::Vec3& shift, double step, double best) const;
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
