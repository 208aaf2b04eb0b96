// Convex polytopes by vertices, facets and planes. What rounding may do to a plane:
// docs/algorithms/convex-decomposition.md, "Excess".
#include <kaboum/geom/convex_polytope.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace kaboum::geom {
namespace {

/// Normals whose rounding may be more than this share of their length are computed again in long
/// double.
constexpr double kPrecise = 1e-10;
/// Those that stay above this share are not known. Below it, the plane is wrong by at most kHeight
/// times the share: once by the normal's direction at the point, and once at the facet, and once by
/// the division by a length that is wrong.
constexpr double kKnown = 1e-4, kHeight = 3;
/// Of a component of a cross product: two products and a difference, each rounded once, of
/// differences that were rounded once, in units of the type's epsilon.
constexpr double kCrossRounding = 4;

/// (b − a) × (c − a), computed in a type, and by how much rounding may falsify it.
template <class Number>
std::pair<Vec3, double> normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  using Vector = Eigen::Matrix<Number, 3, 1>;
  const Vector u = b.cast<Number>() - a.cast<Number>(), w = c.cast<Number>() - a.cast<Number>();
  const Vec3 x = u.cwiseAbs().template cast<double>(), y = w.cwiseAbs().template cast<double>();
  const Vec3 terms(x.y() * y.z() + x.z() * y.y(), x.z() * y.x() + x.x() * y.z(),
                   x.x() * y.y() + x.y() * y.x());
  return {
      u.cross(w).template cast<double>(),
      kCrossRounding * static_cast<double>(std::numeric_limits<Number>::epsilon()) * terms.norm()};
}

}  // namespace

std::optional<FacetPlane> facet_plane(const Vec3& a, const Vec3& b, const Vec3& c) {
  auto [n, error] = normal_of<double>(a, b, c);
  if (!(error < kPrecise * n.norm())) std::tie(n, error) = normal_of<long double>(a, b, c);
  const double length = n.norm();
  if (!(error < kKnown * length)) return std::nullopt;
  return FacetPlane{n / length, n.dot(a) / length, kHeight * error / length};
}

ConvexPolytope::ConvexPolytope(Mesh hull) : hull_(std::move(hull)), box_(bounding_box(hull_)) {
  planes_.reserve(hull_.triangles.size());
  for (const auto& [i, j, k] : hull_.triangles)
    if (const auto plane = facet_plane(hull_.vertices[i], hull_.vertices[j], hull_.vertices[k]))
      planes_.push_back(*plane);
}

bool ConvexPolytope::contains(const Vec3& p) const {
  if (!((box_.min.array() <= p.array()).all() && (p.array() <= box_.max.array()).all()))
    return false;
  return std::none_of(hull_.triangles.begin(), hull_.triangles.end(), [&](const Triangle& t) {
    const auto& v = hull_.vertices;
    return orient3d(v[t[0]], v[t[1]], v[t[2]], p) == Sign::Positive;
  });
}

}  // namespace kaboum::geom
