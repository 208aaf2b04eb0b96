#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Convex hulls of many point sets, one after the other, in the same memory.
///
/// Quickhull on exact orientation tests: every point is on or below every facet's plane, exactly,
/// however flat the set and however many points share a plane. Facets are triangles; where more
/// than three points share a facet's plane it is triangulated, and points inside a facet or an edge
/// may remain as vertices. Source: Barber, Dobkin, Huhdanpaa, The Quickhull algorithm (1996).
class HullBuilder {
 public:
  /// Builds the hull of the points, whose coordinates must be finite and of magnitude below 1e60.
  /// @return false when all points lie in one plane (exactly), or there are fewer than four; then
  ///   there is no hull.
  bool build(std::span<const Vec3> points);

  /// Facets as indices into the points, counter-clockwise seen from outside.
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Indices of the points that facets use, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// The hull as a mesh of its own, vertices in ascending order of the points' indices.
  [[nodiscard]] Mesh mesh() const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Facet {
    Triangle v;
    std::array<std::uint32_t, 3> across;  // facet beyond the edge v[k] → v[k+1]
    Vec3 normal;                          // rounded, not normalised
    double bound;                         // of the rounding error of above()
    std::uint32_t first;                  // list of points above this facet
    std::uint32_t farthest;
    double height;
    bool alive;
    std::uint32_t mark;
  };
  struct Ridge {
    std::uint32_t from, to, outer, outer_edge;
  };

  bool find_simplex(std::array<std::uint32_t, 4>& corner) const;
  std::uint32_t add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Signed height, unnormalised, of a point that is strictly above the facet; 0 otherwise.
  [[nodiscard]] double above(const Facet& facet, const Vec3& p) const;
  void assign(std::uint32_t point, std::uint32_t facet, double height);
  void add_point(std::uint32_t facet);

  std::span<const Vec3> points_;
  Vec3 extent_ = Vec3::Zero();
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> next_;  // of a point in its facet's list
  std::vector<std::uint32_t> stack_, visible_, fresh_, pending_;
  std::vector<Ridge> horizon_;
  std::vector<std::uint32_t> facet_from_;  // point → new facet whose horizon edge starts there
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> vertices_;
  std::uint32_t mark_ = 0;
};

/// Convex hull of points; nullopt when they are coplanar or fewer than four. See HullBuilder.
std::optional<Mesh> convex_hull(std::span<const Vec3> points);

}  // namespace kaboum::geom
