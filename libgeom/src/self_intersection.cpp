// Where a mesh meets itself: pairs out of a hierarchy, decided by exact predicates.
#include <kaboum/base/parallel.h>
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/self_intersection.h>
#include <kaboum/geom/topology.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "triangle_contact.h"

namespace kaboum::geom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

Kernel::Triangle_3 triangle(const NamedTriangle& t) {
  return {point(t.at[0]), point(t.at[1]), point(t.at[2])};
}

/// Whether the corners of b that a does not have lie strictly on one side of a's plane.
bool beside(const NamedTriangle& a, const NamedTriangle& b, const std::array<bool, 3>& common) {
  int above = 0, below = 0, rest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (common[k]) continue;
    ++rest;
    const Sign s = orient3d(a.at[0], a.at[1], a.at[2], b.at[k]);
    above += s == Sign::Positive ? 1 : 0;
    below += s == Sign::Negative ? 1 : 0;
    if (above < rest && below < rest) return false;
  }
  return true;
}

}  // namespace

bool meet_improperly(const NamedTriangle& a, const NamedTriangle& b) {
  std::array<bool, 3> of_a{}, of_b{};
  int common = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (a.name[i] == b.name[k]) {
        of_a[i] = of_b[k] = true;
        ++common;
      }
  if (common > 2) return true;
  // What b has beside the common corners is apart from a's plane, so that b meets it only there.
  if (beside(a, b, of_b) || beside(b, a, of_a)) return false;
  const auto segment = [](const NamedTriangle& t, const std::array<bool, 3>& without) {
    const std::size_t apex = without[0] ? 0 : without[1] ? 1 : 2;
    return Kernel::Segment_3(point(t.at[(apex + 1) % 3]), point(t.at[(apex + 2) % 3]));
  };
  if (common == 0) return CGAL::do_intersect(triangle(a), triangle(b));
  // They meet in more than a corner if, and only if, the side opposite to it, of one, meets the
  // other.
  if (common == 1)
    return CGAL::do_intersect(triangle(a), segment(b, of_b)) ||
           CGAL::do_intersect(triangle(b), segment(a, of_a));
  // In one plane: the same side of the common edge, or not.
  const std::size_t apex = !of_a[0] ? 0 : !of_a[1] ? 1 : 2;
  const std::size_t other = !of_b[0] ? 0 : !of_b[1] ? 1 : 2;
  return CGAL::coplanar_orientation(point(a.at[(apex + 1) % 3]), point(a.at[(apex + 2) % 3]),
                                    point(a.at[apex]), point(b.at[other])) == CGAL::POSITIVE;
}

std::vector<Meeting> meetings(const Mesh& mesh) {
  std::vector<Meeting> result(mesh.triangles.size(), Meeting::Proper);
  if (mesh.empty()) return result;
  const Bvh bvh(mesh);
  const auto named = [&](std::uint32_t t) {
    const Triangle& c = mesh.triangles[t];
    return NamedTriangle{c, {mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]}};
  };
  std::vector<char> flat(mesh.triangles.size(), 0);
  parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t t) {
    const NamedTriangle c = named(static_cast<std::uint32_t>(t));
    flat[t] = c.name[0] == c.name[1] || c.name[1] == c.name[2] || c.name[2] == c.name[0] ||
                      is_degenerate(c.at[0], c.at[1], c.at[2])
                  ? 1
                  : 0;
  });
  std::vector<std::atomic<char>> meets(mesh.triangles.size());
  parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t i) {
    const auto t = static_cast<std::uint32_t>(i);
    if (flat[t] != 0) return;
    const NamedTriangle c = named(t);
    Box3 box;
    for (const Vec3& p : c.at) box.extend(p);
    bvh.traverse([&](const Box3& other) { return overlap(box, other); },
                 [&](std::uint32_t u) {
                   if (u <= t || flat[u] != 0) return;
                   const NamedTriangle d = named(u);
                   Box3 other;
                   for (const Vec3& p : d.at) other.extend(p);
                   if (!overlap(box, other) || !meet_improperly(c, d)) return;
                   meets[t] = 1;
                   meets[u] = 1;
                 });
  });
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (flat[t] != 0)
      result[t] = Meeting::Flat;
    else if (meets[t] != 0)
      result[t] = Meeting::Improper;
  return result;
}

SelfIntersections self_intersections(const Mesh& mesh) {
  SelfIntersections result;
  for (const Meeting m : meetings(mesh)) {
    result.flat += m == Meeting::Flat ? 1 : 0;
    result.triangles += m == Meeting::Improper ? 1 : 0;
  }
  return result;
}

}  // namespace kaboum::geom
