#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/transform.h>

#include <cstdint>
#include <vector>

namespace kaboum::pairs::detail {

using geom::Mesh;
using geom::Transform;
using geom::Vec3;

/// Some triangles of a mesh: all of them lie within `radius` of the hull of the cluster's points.
struct Cluster {
  std::uint32_t first = 0, count = 0;  ///< of the tree's coordinates: count x, then y, then z
  double radius = 0;                   ///< rounded up; 0: the hull of the points holds them
  Vec3 center = Vec3::Zero();          ///< of a ball that holds all of it
  double reach = 0;                    ///< radius of that ball, rounded up
  std::uint32_t left = 0, right = 0;   ///< 0: a leaf, which is one triangle
  std::uint32_t triangle = 0;          ///< of a leaf

  [[nodiscard]] bool leaf() const { return left == 0; }
};

/// A tree of clusters over a mesh's triangles, the root first. From each cluster to its halves the
/// hulls come nearer to the surface; leaves are triangles.
class HullTree {
 public:
  static constexpr std::size_t kMostPoints = 40;  ///< of a cluster

  explicit HullTree(const Mesh& mesh);

  [[nodiscard]] bool empty() const { return clusters_.empty(); }
  [[nodiscard]] const Cluster& operator[](std::uint32_t i) const { return clusters_[i]; }
  [[nodiscard]] const double* x(const Cluster& c) const { return coordinates_.data() + c.first; }
  [[nodiscard]] Vec3 point(const Cluster& c, std::uint32_t i) const {
    const double* at = x(c) + i;
    return {at[0], at[c.count], at[2 * static_cast<std::size_t>(c.count)]};
  }
  /// Largest distance of a point from the frame's origin, rounded up.
  [[nodiscard]] double extent() const { return extent_; }

 private:
  std::uint32_t build(const Mesh& mesh, std::vector<std::uint32_t>& order, std::size_t begin,
                      std::size_t end, const std::vector<Vec3>& centers);

  std::vector<Cluster> clusters_;
  std::vector<double> coordinates_;
  double extent_ = 0;
};

}  // namespace kaboum::pairs::detail
