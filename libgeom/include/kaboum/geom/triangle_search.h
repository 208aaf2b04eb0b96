#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/clip.h>
#include <kaboum/geom/point_triangle.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kaboum::geom {

/// A search structure over a fixed set of triangles that finds the nearest one.
///
/// Branch and bound takes any of them; DistanceQuery is the library's own.
class TriangleSearch {
 public:
  struct Nearest {
    std::uint32_t triangle;  ///< a triangle whose distance is ≤ upper
    double lower;            ///< bracket of the distance to the whole set
    double upper;
    std::uint32_t looked = 0;  ///< triangles looked at: what it took
  };
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  TriangleSearch(const TriangleSearch&) = delete;
  TriangleSearch& operator=(const TriangleSearch&) = delete;
  virtual ~TriangleSearch() = default;

  /// Nearest triangle; `hint`, a triangle likely to be near, only makes it faster: the bracket's
  /// width does not depend on it beyond rounding. Safe to call from several threads.
  [[nodiscard]] virtual Nearest nearest(const Vec3& p, std::uint32_t hint = kNone) const = 0;

  /// The triangle's corners.
  [[nodiscard]] const std::array<Vec3, 3>& corners(std::uint32_t triangle) const {
    return corners_[position_[triangle]];
  }

  /// Bracket of the distance to one triangle.
  [[nodiscard]] DistanceBounds to_triangle(const Vec3& p, std::uint32_t triangle) const {
    const auto& [a, b, c] = corners(triangle);
    return point_triangle_distance(p, a, b, c);
  }

  /// The corners of all triangles, in an order in which neighbours are mostly near each other.
  [[nodiscard]] std::span<const std::array<Vec3, 3>> ordered() const { return corners_; }

  [[nodiscard]] const Box3& box() const { return box_; }
  [[nodiscard]] std::size_t triangle_count() const { return corners_.size(); }

 protected:
  /// Copies the triangles' corners, in `order` (all indices once), along some path through space.
  /// @throws Error{InvalidInput} if the mesh has no triangles.
  TriangleSearch(const Mesh& mesh, std::span<const std::uint32_t> order);

  std::vector<std::array<Vec3, 3>> corners_;  // in the given order
  std::vector<std::uint32_t> position_;       // triangle → place in corners_
  Box3 box_;
};

/// Distance queries through the library's own hierarchy.
class DistanceQuery final : public TriangleSearch {
 public:
  /// Copies what it needs of the mesh.
  /// @throws Error{InvalidInput} if the mesh has no triangles.
  explicit DistanceQuery(const Mesh& mesh);

  [[nodiscard]] Nearest nearest(const Vec3& p, std::uint32_t hint = kNone) const override;

  /// Some triangle whose distance from p is certainly ≤ radius, starting the search at `hint`;
  /// kNone if there is none (or, within rounding of the radius, if it was missed).
  [[nodiscard]] std::uint32_t within(const Vec3& p, double radius,
                                     std::uint32_t hint = kNone) const;

  /// True if every point of the polygon is within `radius`: decided by cutting it along the prisms
  /// of nearest triangles until each piece's corners are within the radius of one triangle (the
  /// distance to one triangle is convex). False also when that did not succeed in `max_pieces`
  /// pieces.
  [[nodiscard]] bool all_within(const ConvexPolygon& polygon, double radius,
                                int max_pieces = 256) const;

  /// The hierarchy, Bvh::of_parts.
  [[nodiscard]] const Bvh& hierarchy() const { return bvh_; }

 private:
  DistanceQuery(const Mesh& mesh, Bvh bvh);

  Bvh bvh_;
  std::vector<std::uint32_t> place_;  // of the hierarchy's entries in corners_
};

}  // namespace kaboum::geom
