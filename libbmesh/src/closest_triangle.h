#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/wide_bvh.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace kaboum::bmesh {

using geom::closest_point;
using geom::Vec3;

/// The square of its distance.
inline double squared_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  return (p - closest_point(p, t[0], t[1], t[2])).squaredNorm();
}

/// Fast, uncertified distances to a fixed set of triangles.
class ClosestTriangle {
 public:
  using Vicinity = geom::WideBvh::Vicinity;

  /// Keeps a reference to the mesh, which must outlive this object. @pre it has triangles.
  /// @param keeps_hierarchy  for others.
  explicit ClosestTriangle(const geom::Mesh& mesh, bool keeps_hierarchy = true);

  /// Squared distance of p from the set, or of any triangle that is within √enough.
  ///
  /// @param hint  a place of a triangle likely to be near (any number at first); receives the place
  ///   of the triangle found, to be the hint of the next query near by.
  /// @param steps  raised, when not null, by the nanoseconds that it takes, about.
  /// @param vicinity  looked at instead of all, when not null and large enough.
  double squared(const Vec3& p, std::uint32_t& hint, double enough = 0,
                 std::uint64_t* steps = nullptr, const Vicinity* vicinity = nullptr) const;

  /// Makes the vicinity hold what is in the ball, for points there.
  void gather(const Vec3& center, double radius, Vicinity& out,
              std::uint64_t* steps = nullptr) const {
    const std::uint64_t visited = wide_.gather(center, radius, out);
    if (steps != nullptr) *steps += kNode * visited;
  }

  /// Squared distance of a triangle that is at least as near to p as all across its edges, or
  /// within √enough, or a dozen triangles from the hint: mostly the nearest, where the hint is the
  /// triangle that was nearest to a point near by.
  /// @param hint  where it is looked for first; receives the place of the triangle found.
  double squared_near(const Vec3& p, std::uint32_t& hint, double enough = 0) const {
    if (hint >= triangles_.size()) hint = 0;
    double first = 0;
    const Found found = walk(p, hint, enough, first);
    hint = found.place;
    return found.squared;
  }

  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t place) const {
    const geom::Triangle& t = triangles_[place];
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }
  /// The triangle's index in the mesh.
  [[nodiscard]] std::uint32_t triangle(std::uint32_t place) const { return order_[place]; }

  /// The hierarchy over the mesh, for others to search it, too; null if it is not kept.
  [[nodiscard]] const std::shared_ptr<const geom::Bvh>& hierarchy() const { return bvh_; }

 private:
  static constexpr std::uint64_t kNode = 30;  ///< [ns] that a box or leaf takes, about

  void find_neighbours();
  /// A triangle by its place, and its squared distance from a point.
  struct Found {
    std::uint32_t place;
    double squared;
  };
  /// Goes from a triangle across the edges beyond which p is, as long as that does not lead away.
  /// @param squared  receives the distance of the first one.
  [[nodiscard]] Found walk(const Vec3& p, std::uint32_t place, double enough,
                           double& squared) const;

  const geom::Mesh& mesh_;
  std::shared_ptr<const geom::Bvh> bvh_;
  std::vector<std::uint32_t> order_;
  std::vector<geom::Triangle> triangles_;             // in the tree's order
  std::vector<std::array<std::uint32_t, 3>> across_;  // their edges; itself where there is none
  geom::WideBvh wide_;
};

}  // namespace kaboum::bmesh
