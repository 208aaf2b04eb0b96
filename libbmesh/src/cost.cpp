// What contractions cost: quadrics of planes as in [garland1997], with the weights of
// [gaschler2016] §4.3 or of distances.

#include "cost.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include <kaboum/base/parallel.h>
#include "placement.h"

namespace kaboum::bmesh {
namespace {

using geom::Triangle;

constexpr double kAnticipationPlanes = 3, kAnticipationDistance = 8;

/// The corners (3·triangle + k) at each vertex, in their order.
class Incidence {
 public:
  explicit Incidence(const geom::Mesh& mesh)
      : start_(mesh.vertices.size() + 1, 0), corner_(3 * mesh.triangles.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) ++start_[v + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    std::uint32_t c = 0;
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) corner_[next[v]++] = c++;
  }
  [[nodiscard]] std::span<const std::uint32_t> corners(std::uint32_t v) const {
    return std::span(corner_).subspan(start_[v], start_[v + 1] - start_[v]);
  }

 private:
  std::vector<std::uint32_t> start_, corner_;
};

/// Room for rounding when pairs of normals are ruled out by their angles with a third.
constexpr double kAngleRounding = 1e-9;
/// Unit normals whose sum is shorter are opposite: the mean has no direction.
constexpr double kOpposite = 1e-6;

/// Quadrics of the planes around each vertex.
class InitialQuadrics {
 public:
  InitialQuadrics(const geom::Mesh& mesh, const Vec3& origin, bool by_area, double sharp_angle)
      : mesh_(mesh),
        origin_(origin),
        by_area_(by_area),
        limit_(std::cos(sharp_angle * std::numbers::pi / 180)),
        half_limit_(std::cos(sharp_angle * std::numbers::pi / 360) + kAngleRounding),
        at_(mesh),
        plane_(mesh.triangles.size()) {
    parallel_for_light(plane_.size(), [&](std::size_t t) {
      const Triangle& tri = mesh.triangles[t];
      const Vec3& a = mesh.vertices[tri[0]];
      const Vec3 n = (mesh.vertices[tri[1]] - a).cross(mesh.vertices[tri[2]] - a);
      const double length = n.norm();
      plane_[t] = {length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero()), 0.5 * length};
    });
  }

  [[nodiscard]] Quadric planes(std::uint32_t v) const {
    const Vec3 p = mesh_.vertices[v] - origin_;
    Quadric sum;
    for (const std::uint32_t c : at_.corners(v)) {
      const Plane& plane = plane_[c / 3];
      Quadric q = plane_quadric(p, plane.normal);
      if (by_area_) q *= plane.area;
      sum += q;
    }
    return sum;
  }

  /// Squared distances to the centres of the triangles.
  [[nodiscard]] Quadric centres(std::uint32_t v) const {
    Quadric sum;
    for (const std::uint32_t c : at_.corners(v)) {
      Vec3 centre = Vec3::Zero();
      for (const std::uint32_t w : mesh_.triangles[c / 3]) centre += mesh_.vertices[w] - origin_;
      sum += point_quadric(centre / 3.0);
    }
    return sum;
  }

  /// Planes across the sharp edges at v.
  void add_sharp_edges(std::uint32_t v, Quadric& sum) const {
    if (all_close(v)) return;
    const Vec3 p = mesh_.vertices[v] - origin_;
    for (const std::uint32_t c : at_.corners(v)) {
      const Vec3& n = plane_[c / 3].normal;
      const std::uint32_t w = corner_of(c, 1);
      for (const std::uint32_t d : at_.corners(v)) {  // runs the edge the other way
        if (corner_of(d, 2) != w || n.dot(plane_[d / 3].normal) >= limit_) continue;
        const Vec3 both = n + plane_[d / 3].normal;
        const Vec3 across =
            both.norm() > kOpposite ? both : Vec3((mesh_.vertices[w] - mesh_.vertices[v]).cross(n));
        if (across.norm() > 0) sum += plane_quadric(p, across.normalized());
      }
    }
  }

 private:
  struct Plane {
    Vec3 normal;  // unit, or zero
    double area;
  };

  [[nodiscard]] std::uint32_t corner_of(std::uint32_t c, std::uint32_t after) const {
    return mesh_.triangles[c / 3][(c % 3 + after) % 3];
  }

  /// Whether no two of a vertex's normals are so far apart: each is within half of that of the
  /// first.
  [[nodiscard]] bool all_close(std::uint32_t v) const {
    const std::span<const std::uint32_t> corners = at_.corners(v);
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t c) {
      return plane_[c / 3].normal.dot(plane_[corners.front() / 3].normal) > half_limit_;
    });
  }

  const geom::Mesh& mesh_;
  const Vec3& origin_;
  bool by_area_;
  double limit_, half_limit_;  // cosines
  Incidence at_;
  std::vector<Plane> plane_;
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
  const InitialQuadrics around(mesh, origin_, by_area(),
                               options_.sharp_angle.value_or(kSharpAngle));
  const bool centres = options_.cost == Cost::Triangles;
  const bool sharp = !centres && !by_area() && options_.sharp_angle.value_or(kSharpAngle) < 180;
  std::vector<Quadric> quadric(mesh.vertices.size());
  parallel_for_light(quadric.size(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    quadric[v] = centres ? around.centres(v) : around.planes(v);
    if (sharp) around.add_sharp_edges(v, quadric[v]);
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

/// Square of the share of an edge's length that its contraction costs.
constexpr double kLengthCost = 1e-8;

/// Prefers short edges where the quadric is indifferent, as in planes: 10^-4 of the length.
double length_cost(const Quadric& q, double squared_length) {
  return kLengthCost * q.trace() * squared_length;
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
