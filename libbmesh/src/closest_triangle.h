#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "four_triangles.h"

namespace kaboum::bmesh {

/// Point of the triangle (a, b, c) closest to p, in rounded arithmetic: for costs, never for
/// certificates. Source: C. Ericson, Real-Time Collision Detection (2005), 5.1.5.
inline Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 > d3 ? d1 / (d1 - d3) : 0) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 > d6 ? d2 / (d2 - d6) : 0) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double sum = (d4 - d3) + (d5 - d6);
    return b + (sum > 0 ? (d4 - d3) / sum : 0) * (c - b);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

/// The square of its distance.
inline double squared_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  return (p - closest_point(p, t[0], t[1], t[2])).squaredNorm();
}

/// Fast, uncertified distances to a fixed set of triangles.
class ClosestTriangle {
 public:
  /// Keeps a reference to the mesh, which must outlive this object. @pre it has triangles.
  explicit ClosestTriangle(const geom::Mesh& mesh);

  /// Squared distance of p from the set, or of any triangle that is within √enough.
  ///
  /// @param hint  a place of a triangle likely to be near (any number at first); receives the place
  ///   of the triangle found, to be the hint of the next query near by.
  /// @param steps  raised, when not null, by the nanoseconds that it takes, about.
  double squared(const Vec3& p, std::uint32_t& hint, double enough = 0,
                 std::uint64_t* steps = nullptr) const;

  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t place) const {
    const geom::Triangle& t = triangles_[place];
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }
  /// The triangle's index in the mesh.
  [[nodiscard]] std::uint32_t triangle(std::uint32_t place) const { return bvh_->order()[place]; }

  /// The hierarchy over the mesh, for others to search it, too.
  [[nodiscard]] const std::shared_ptr<const geom::Bvh>& hierarchy() const { return bvh_; }

 private:
  /// Boxes of four nodes; those that are not there are nowhere.
  struct Node {
    static constexpr float kFar = std::numeric_limits<float>::infinity();
    std::array<std::array<float, 4>, 3> low{
        {{kFar, kFar, kFar, kFar}, {kFar, kFar, kFar, kFar}, {kFar, kFar, kFar, kFar}}};
    std::array<std::array<float, 4>, 3> high{
        {{-kFar, -kFar, -kFar, -kFar}, {-kFar, -kFar, -kFar, -kFar}, {-kFar, -kFar, -kFar, -kFar}}};
    std::array<std::uint32_t, 4> child{};
  };
  struct Leaf {
    FourTriangles triangles;
    std::uint32_t first, count;  // places
  };
  std::uint32_t add(std::uint32_t index);

  const geom::Mesh& mesh_;
  std::shared_ptr<const geom::Bvh> bvh_;
  std::vector<geom::Triangle> triangles_;  // in the tree's order
  Frame frame_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::uint32_t root_ = 0;
};

}  // namespace kaboum::bmesh
