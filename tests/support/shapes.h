#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <functional>
#include <vector>

/// The surfaces that the families are made of. Deterministic; closed ones are oriented outwards.
namespace kaboum::test {

using geom::Mesh;
using geom::Vec3;

// -- convex --------------------------------------------------------------------------------------
/// Icosahedron, each triangle split into four `level` times, corners put onto the unit sphere.
Mesh icosphere(int level);
/// Unit sphere with poles of valence `segments`.
Mesh uv_sphere(int segments, int rings);
/// Axis-aligned box from the origin, each face an n × n grid of quads; faces exactly planar.
Mesh box(const Vec3& size, int n);
/// Prism over a regular polygon, unit radius, z from 0 to `height`; side walls exactly planar.
/// Sides and caps have `side_rows` and `cap_rings` subdivisions; cap_rings = 0 leaves the caps'
/// middle vertex out: fans from a corner of the rim, with triangles as thin as slivers.
Mesh cylinder(int segments, double height, int side_rows, int cap_rings);
/// Cone with an apex of valence `segments` and a fan as base.
Mesh cone(int segments, double height);
/// Convex hull; exact, O(n²). Points on a facet are left out.
/// @throws std::invalid_argument when all points are coplanar.
Mesh convex_hull(const std::vector<Vec3>& points);
/// Hull of n random points of the ball, the cube or the sphere.
enum class Cloud { Ball, Cube, Sphere };
Mesh random_hull(int n, Cloud cloud, std::uint32_t seed);

// -- curved --------------------------------------------------------------------------------------
/// Torus about z.
Mesh torus(double major, double minor, int segments, int sides);
/// Tube round a closed curve given over [0, 2π).
Mesh tube(const std::function<Vec3(double)>& curve, double radius, int segments, int sides);
/// Tube round the (p, q) torus knot on a torus of radii 1 and 0.4.
Mesh torus_knot(int p, int q, double radius, int segments, int sides);

// -- open, or without inside ---------------------------------------------------------------------
/// n × n quads over the unit square, z = height(x, y).
Mesh grid(int n, const std::function<double(double, double)>& height);
/// Band with one half turn; not orientable, so neighbours along one seam run the same way.
Mesh moebius_strip(int segments, int rows);

// -- changes -------------------------------------------------------------------------------------
Mesh merged(const std::vector<Mesh>& parts);  ///< side by side, no welding
Mesh welded(const Mesh& mesh);                ///< equal coordinates become one index
Mesh flipped(Mesh mesh);                      ///< orientation reversed
Mesh translated(Mesh mesh, const Vec3& by);
Mesh scaled(Mesh mesh, const Vec3& by);  ///< by positive factors
/// Rotated about an odd axis by an odd angle; rounds, so planes bend by an ulp.
Mesh rotated(Mesh mesh, double angle);
/// Vertices moved along the ray from the origin by up to ± amplitude of their distance.
Mesh noisy(Mesh mesh, double amplitude, std::uint32_t seed);
/// Coordinates rounded to float32.
Mesh to_float(Mesh mesh);
/// Triangles for which `drop` of the centroid holds are removed, unused vertices stay out.
Mesh without(const Mesh& mesh, const std::function<bool(const Vec3&)>& drop);
/// Each triangle with three vertices of its own.
Mesh soup(const Mesh& mesh);
/// `count` triangles split at an edge's midpoint on one side only; the gap is closed by a triangle
/// of (nearly) no area between the edge and its halves. Still a closed chain by indices.
Mesh with_t_junctions(const Mesh& mesh, int count, std::uint32_t seed);
/// `count` edges opened by a zero-length edge: a second vertex at the same place and two triangles.
Mesh with_repeated_vertices(const Mesh& mesh, int count, std::uint32_t seed);

}  // namespace kaboum::test
