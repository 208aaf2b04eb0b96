#include "cost.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "in_parallel.h"
#include "placement.h"

namespace kaboum::bmesh {
namespace {

using geom::Triangle;

constexpr double kAnticipationPlanes = 3, kAnticipationDistance = 8;

/// The corners (3·triangle + k) at each vertex, in their order.
struct Incidence {
  explicit Incidence(const geom::Mesh& mesh)
      : start(mesh.vertices.size() + 1, 0), corner(3 * mesh.triangles.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) ++start[v + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    std::uint32_t c = 0;
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) corner[next[v]++] = c++;
  }
  std::vector<std::uint32_t> start, corner;
};

}  // namespace

CostModel::CostModel(const DecimateOptions& options, const geom::Box3& box)
    : options_(options),
      adapted_(options.cost == Cost::PlanesAdapted || options.cost == Cost::PlanesDiagonal),
      anticipation_(options.cost == Cost::Distance ? kAnticipationDistance
                    : options.cost == Cost::Planes || options.cost == Cost::Mean
                        ? kAnticipationPlanes
                        : 1),
      regularisation_(by_area() ? kRegularisationDistance : kRegularisation),
      origin_(box.center()) {}

std::vector<Quadric> CostModel::initial(const geom::Mesh& mesh) const {
  const Incidence at(mesh);
  const auto local = [&](std::uint32_t v) -> Vec3 { return mesh.vertices[v] - origin_; };
  struct Plane {
    Vec3 normal;  // unit, or zero
    double area;
  };
  std::vector<Plane> plane(mesh.triangles.size());
  in_parallel(plane.size(), [&](std::size_t t) {
    const Triangle& tri = mesh.triangles[t];
    const Vec3& a = mesh.vertices[tri[0]];
    const Vec3 n = (mesh.vertices[tri[1]] - a).cross(mesh.vertices[tri[2]] - a);
    const double length = n.norm();
    plane[t] = {length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero()), 0.5 * length};
  });
  const bool sharp = options_.cost != Cost::Triangles && !by_area() && options_.sharp_angle < 180;
  const double limit = std::cos(options_.sharp_angle * std::numbers::pi / 180);
  // Whether no two of a vertex's normals can be farther apart: each is within half of that of one.
  const double half_limit = std::cos(options_.sharp_angle * std::numbers::pi / 360) + 1e-9;
  const auto all_close = [&](std::uint32_t v) {
    if (at.start[v] == at.start[v + 1]) return true;
    const Vec3& one = plane[at.corner[at.start[v]] / 3].normal;
    for (std::uint32_t j = at.start[v] + 1; j < at.start[v + 1]; ++j)
      if (!(plane[at.corner[j] / 3].normal.dot(one) > half_limit)) return false;
    return true;
  };
  std::vector<Quadric> quadric(mesh.vertices.size());
  in_parallel(quadric.size(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    Quadric& sum = quadric[v];
    const std::uint32_t first = at.start[v], last = at.start[v + 1];
    for (std::uint32_t j = first; j < last; ++j) {
      const std::uint32_t t = at.corner[j] / 3;
      const Triangle& tri = mesh.triangles[t];
      Quadric q = options_.cost == Cost::Triangles
                      ? point_quadric((local(tri[0]) + local(tri[1]) + local(tri[2])) / 3.0)
                      : plane_quadric(local(tri[0]), plane[t].normal);
      if (by_area()) q *= plane[t].area;
      sum += q;
    }
    if (!sharp || all_close(v)) return;
    // Every edge from v, where another triangle runs it the other way.
    for (std::uint32_t j = first; j < last; ++j) {
      const std::uint32_t t = at.corner[j] / 3,
                          w = mesh.triangles[t][(at.corner[j] + 1 - 3 * t) % 3];
      for (std::uint32_t k = first; k < last; ++k) {
        const std::uint32_t u = at.corner[k] / 3;
        if (mesh.triangles[u][(at.corner[k] + 2 - 3 * u) % 3] != w) continue;
        if (plane[t].normal.dot(plane[u].normal) >= limit) continue;
        const Vec3 both = plane[t].normal + plane[u].normal;
        const Vec3 across =
            both.norm() > 1e-6 ? both
                               : Vec3((mesh.vertices[w] - mesh.vertices[v]).cross(plane[t].normal));
        if (across.norm() > 0) sum += plane_quadric(local(std::min(v, w)), across.normalized());
      }
    }
  });
  return quadric;
}

Quadric CostModel::adapted(const Quadric& a, const Quadric& b, const Vec3& pa,
                           const Vec3& pb) const {
  if (options_.cost == Cost::PlanesAdapted) return add_adapted(a, b);
  const double length = (pb - pa).norm();
  return length > 0 ? add_diagonal(a, b, length, options_.as_printed) : a + b;
}

/// The quadric's value or, for the distance, the root mean square of the distances to the planes
/// that it stands for. [length²] or [length]
double CostModel::to_key(const Quadric& q, double value) const {
  if (options_.cost != Cost::Distance) return value;
  const double trace = q.trace();
  return trace > 0 ? std::sqrt(value / trace) : 0;
}

namespace {

/// Prefers short edges where the quadric is indifferent, as in planes: 10^-4 of the length.
double length_cost(const Quadric& q, double squared_length) {
  return 1e-8 * q.trace() * squared_length;
}

}  // namespace

double CostModel::free_minimum(const Quadric& q, const Vec3& pa, const Vec3& pb) const {
  const Vec3 middle = 0.5 * ((pa - origin_) + (pb - origin_));
  return std::max(0.0, unconstrained_minimum(q, middle, regularisation_));
}

double CostModel::key(const Quadric& q, const Vec3& place, double squared_length) const {
  return to_key(q, std::max(0.0, q(place - origin_)) + length_cost(q, squared_length));
}

double CostModel::expected_key(const Quadric& q, const Vec3& pa, const Vec3& pb) const {
  return to_key(q,
                anticipation_ * free_minimum(q, pa, pb) + length_cost(q, (pb - pa).squaredNorm()));
}

double CostModel::least_key(const Quadric& q, const Vec3& pa, const Vec3& pb) const {
  return to_key(q, free_minimum(q, pa, pb));
}

}  // namespace kaboum::bmesh
