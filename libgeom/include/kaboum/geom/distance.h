#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/clip.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Certified bracket of a distance: lower ≤ true distance ≤ upper, in spite of rounding. [length]
struct DistanceBounds {
  double lower;
  double upper;
};

/// Distance of point p to the closed triangle (a, b, c), which may be degenerate.
///
/// The closest point is computed in rounded arithmetic; the bounds hold however badly that went.
/// `upper` is the distance to a convex combination of the corners, `lower` the distance to a plane
/// that separates p from the corners, both widened by the rounding error derived in
/// docs/algorithms/distances.md.
///
/// @pre coordinates of magnitude below 1e70; differences that matter above 1e-70.
DistanceBounds point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// True if the triangle's box, and so the triangle, is certainly farther from p than `radius`.
bool box_beyond(const Vec3& p, const std::array<Vec3, 3>& t, double radius);

/// The upper bound alone, cheaper: never below the distance, and above point_triangle_distance's
/// bound by rounding at most.
double point_triangle_upper(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The point of the triangle (a, b, c) nearest to p, rounded; for reports.
Vec3 nearest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A search structure over a fixed set of triangles that finds the nearest one.
///
/// What branch and bound needs; DistanceQuery is the library's own, others may be given instead.
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

/// One-sided Hausdorff distance sup_{x∈A} d(x, B) between surfaces. [length]
struct DirectedDistance {
  double max_lower = 0;  ///< certified bracket of the supremum
  double max_upper = 0;
  Vec3 at = Vec3::Zero();  ///< point of A, within rounding, whose distance is at least max_lower
  bool within_gap = true;  ///< false: the gap was not reached in the work allowed (max_pieces at a
                           ///< time), or coordinates are too large for it (see below)
  std::uint64_t queries = 0;
};

struct DistanceOptions {
  double relative_gap = 1e-3;  ///< stop when upper ≤ lower · (1 + relative_gap) …
  double absolute_gap = 1e-9;  ///< … or upper ≤ lower + absolute_gap · diagonal of A and B's box
                               ///< (much smaller ones are reached slowly, if at all)
  double offset = 0;  ///< the gap is wanted for max(0, distance − offset); the bracket returned is
                      ///< that of the distance itself [length]
  std::size_t max_pieces = std::size_t{1} << 23;  ///< at a time, of some 400 bytes each

  /// The largest upper bound that meets the wish, given a lower bound. @param diagonal of the box.
  [[nodiscard]] double wished(double lower, double diagonal) const {
    const double beyond = lower > offset ? lower - offset : 0;
    const double wide = beyond * (1 + relative_gap), least = beyond + absolute_gap * diagonal;
    return offset + (wide > least ? wide : least);
  }
};

/// The solid that B bounds, for distances that are 0 inside it.
class Interior {
 public:
  Interior() = default;
  Interior(const Interior&) = delete;
  Interior& operator=(const Interior&) = delete;
  virtual ~Interior() = default;

  /// Decides whether p lies in the solid: exactly, or nullopt. Safe to call from several
  /// threads, as all of these.
  ///
  /// @param free  lower bound of p's distance to the triangles of B, if one is known: within it
  ///   nothing changes, which helps where p lies on a fold inside the solid.
  [[nodiscard]] virtual std::optional<bool> contains(const Vec3& p, double free) const = 0;

  /// True if the ball is certainly part of the solid, given a lower bound of its centre's distance
  /// to the triangles of B.
  [[nodiscard]] virtual bool covers_ball(const Vec3& center, double radius,
                                         double distance) const = 0;

  /// True if every point of the convex hull of the corners is certainly within `slack` of the
  /// solid. May say no where it is hard to tell.
  [[nodiscard]] virtual bool covers(std::span<const Vec3> corners, double slack) const = 0;
};

/// Branch and bound over convex pieces of A's triangles.
///
/// Upper bound of a piece: d(·, t) is convex for one triangle t of B, so its largest value over the
/// piece is at a corner; t is the triangle nearest to the piece's centroid, or to its worst corner.
/// A piece that is not settled is cut along the prism of t, so that coplanar surfaces fall apart
/// into the cells in which one triangle of B is nearest, instead of being halved down to the gap.
/// Rounds are evaluated in parallel (oneTBB); the result does not depend on the number of threads.
///
/// Corners made by cuts and centroids are rounded; the bracket allows for that, some 1e-14 times
/// the largest |coordinate| of A. Translate meshes far from the origin first, where that is exact.
///
/// @pre A and B have triangles and finite coordinates; B is given as a query.
/// @param inside  when not null, the distance of points of A to the solid that B bounds: 0 inside.
/// @throws Error{InvalidInput} when A has no triangles.
DirectedDistance directed_distance(const Mesh& a, const TriangleSearch& b,
                                   const DistanceOptions& options = {},
                                   const Interior* inside = nullptr);

/// The same for A's triangles as its own search structure holds them; faster where that exists.
DirectedDistance directed_distance(const TriangleSearch& a, const TriangleSearch& b,
                                   const DistanceOptions& options = {},
                                   const Interior* inside = nullptr);

}  // namespace kaboum::geom
