#pragma once

#include <kaboum/collide/bounding_set.h>
#include <kaboum/geom/polygon2.h>

#include <cstddef>
#include <optional>
#include <vector>

/// Flat faces of convex sets, and their outlines.
namespace kaboum::scene {

using geom::Centroid;
using geom::centroid_of;
using geom::common_part;
using geom::convex_hull;
using geom::cross;
using geom::eroded;
using geom::left_of;
using geom::longest_edge;
using geom::Polygon2;
using geom::reach_within;
using geom::Vec2;
using geom::Vec3;

/// Between normals of faces that count as parallel, and from level. [rad]
inline constexpr double kParallel = 1e-3;
/// Share of a size that counts as nothing.
inline constexpr double kNothing = 1e-9;

/// A flat face of a convex body.
struct Face {
  std::size_t body = 0;
  Vec3 normal;
  double offset = 0;          ///< normal · x of its points
  std::vector<Vec3> corners;  ///< of its triangles; some are there twice
};

/// A plane's coordinates.
struct Axes {
  explicit Axes(const Vec3& normal) : u(normal.unitOrthogonal()), v(normal.cross(u)) {}
  Vec3 u, v;
  [[nodiscard]] Vec2 operator()(const Vec3& p) const { return {u.dot(p), v.dot(p)}; }
};

/// A set's flat faces: the facets of its bodies' cores, moved out by their radii. What is round has
/// none.
class Faces {
 public:
  /// Refers to the set.
  explicit Faces(const collide::BoundingSet& set);

  [[nodiscard]] const std::vector<Face>& all() const { return all_; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] const collide::BoundingSet& set() const { return set_; }

  /// True if the point just outside of a face is in another body.
  [[nodiscard]] bool is_covered(const Face& face, const Vec3& point) const;
  /// Where other bodies are just outside of a face, in coordinates of its plane.
  [[nodiscard]] std::vector<Polygon2> covers(const Face& face, const Axes& axes) const;

 private:
  [[nodiscard]] bool holds(std::size_t body, const Vec3& point) const;
  void add(const geom::ConvexBody& of, std::size_t body);

  const collide::BoundingSet& set_;
  double size_;
  std::vector<Face> all_;
  std::vector<std::size_t> first_of_;
};

/// A face in a plane's coordinates.
Polygon2 flattened(const Face& face, const Axes& axes);

}  // namespace kaboum::scene
