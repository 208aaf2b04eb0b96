// Distances at the corners of small triangles.

#include <kaboum/page/gaps.h>

#include <kaboum/base/parallel.h>
#include <kaboum/geom/body_polytopes.h>

#include <algorithm>

#include <kaboum/picture/refine.h>

namespace kaboum::page {
namespace {

using geom::Vec3;

constexpr double kParts = 80;        ///< of the extent, along an edge
constexpr double kMostCuts = 50000;  ///< triangles that come of cutting larger ones, in one layer

/// A convex polytope as the planes of its facets, to ask whether points are within.
struct Inside {
  geom::Box3 box;
  std::vector<std::pair<Vec3, double>> planes;

  Inside(const geom::Mesh& hull, double slack) : box(geom::bounding_box(hull)) {
    for (const geom::Triangle& t : hull.triangles) {
      const Vec3& a = hull.vertices[t[0]];
      const Vec3 normal = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
      if (!(normal.norm() > 0)) continue;
      planes.emplace_back(normal.normalized(), normal.normalized().dot(a) - slack);
    }
  }

  [[nodiscard]] bool has(const Vec3& p) const {
    return (p.array() > box.min.array()).all() && (p.array() < box.max.array()).all() &&
           std::ranges::all_of(
               planes, [&](const auto& plane) { return plane.first.dot(p) < plane.second; });
  }
};

}  // namespace

DistanceOf distance_to(const geom::DistanceQuery& triangles) {
  return [&triangles](const Vec3& p) { return triangles.nearest(p).upper; };
}

Shape measured(const geom::Mesh& mesh, double extent, const DistanceOf& distance) {
  Shape out{picture::refined(mesh, extent / kParts, kMostCuts)};
  out.distances.resize(out.mesh.vertices.size());
  parallel_for(std::size_t{0}, out.distances.size(),
               [&](std::size_t i) { out.distances[i] = distance(out.mesh.vertices[i]); },
               {.grain = 256});
  return out;
}

std::vector<Shape> measured(std::span<const geom::ConvexBody> bodies, double extent,
                            std::span<const DistanceOf> distances) {
  std::vector<geom::Mesh> surfaces;
  std::vector<Inside> insides;
  insides.reserve(bodies.size());
  for (const geom::ConvexBody& body : bodies) surfaces.push_back(geom::surface_of(body));
  for (const geom::Mesh& surface : surfaces) insides.emplace_back(surface, 1e-7 * extent);
  std::vector<Shape> out(bodies.size());
  const double most = kMostCuts / static_cast<double>(std::max<std::size_t>(1, bodies.size()));
  parallel_for(std::size_t{0}, bodies.size(),
               [&](std::size_t i) {
                 Shape& shape = out[i];
                 shape.mesh = picture::refined(surfaces[i], extent / kParts, most);
                 for (const Vec3& p : shape.mesh.vertices) {
                   bool within = false;
                   for (std::size_t j = 0; j < bodies.size() && !within; ++j)
                     within = j != i && insides[j].has(p);
                   shape.distances.push_back(within ? -1 : distances[i](p));
                 }
               },
               {.alone = true});
  return out;
}

}  // namespace kaboum::page
