// Facets of polytopes whose corners are rounded.

#include <kaboum/geom/facets.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace kaboum::geom {
namespace {

/// Corners are rounded by less than one spacing each; a plane of three of them is off by a few
/// times that where a facet reaches beyond its largest triangle.
constexpr double kSpacings = 8;

}  // namespace

std::size_t facet_count(const Mesh& hull, double within) {
  const auto normal_of = [&](const Triangle& t) {
    const Vec3& a = hull.vertices[t[0]];
    return Vec3((hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a));
  };
  std::vector<double> areas;
  for (const Triangle& t : hull.triangles) areas.push_back(normal_of(t).norm());
  std::vector<std::size_t> left(hull.triangles.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::ranges::stable_sort(left, [&](std::size_t a, std::size_t b) { return areas[a] > areas[b]; });
  std::size_t count = 0;
  while (!left.empty()) {
    ++count;
    const Triangle seed = hull.triangles[left.front()];
    const Vec3& at = hull.vertices[seed[0]];
    const Vec3 normal = normal_of(seed).normalized();
    std::vector<char> in_plane;
    for (const Vec3& p : hull.vertices)
      in_plane.push_back(std::abs(normal.dot(p - at)) <= within ? 1 : 0);
    // The seed is in its plane, however small it is.
    left.erase(left.begin());
    std::erase_if(left, [&](std::size_t t) {
      return std::ranges::all_of(hull.triangles[t], [&](auto v) { return in_plane[v] != 0; });
    });
  }
  return count;
}

std::size_t float32_facet_count(const Mesh& hull) {
  double magnitude = 0;
  for (const Vec3& p : hull.vertices) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  return facet_count(hull, kSpacings * float32_spacing(magnitude));
}

}  // namespace kaboum::geom
