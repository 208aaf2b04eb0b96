// The distance of two polytopes against a number, in dyadic arithmetic: the algorithm of Gilbert,
// Johnson and Keerthi (1988) with exact simplices, which ends because every step comes nearer.

#include "exact_proximity.h"

#include <kaboum/base/error.h>

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace kaboum::collide::detail {
namespace {

#ifdef CGAL_HAS_MPZF
using Number = CGAL::Mpzf;
#else
using Number = CGAL::Exact_rational;
#endif

using Vector = std::array<Number, 3>;

Vector exact(const geom::Vec3& v) { return {Number(v.x()), Number(v.y()), Number(v.z())}; }

Number dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Matrix and vector of a pose.
struct Pose {
  explicit Pose(const geom::Transform& t) : translation(exact(t.translation)) {
    for (int i = 0; i < 3; ++i) row[i] = exact(t.linear.row(i).transpose());
  }
  [[nodiscard]] Vector place(const geom::Vec3& p) const {
    const Vector v = exact(p);
    return {dot(row[0], v) + translation[0], dot(row[1], v) + translation[1],
            dot(row[2], v) + translation[2]};
  }
  /// Transposed matrix times vector.
  [[nodiscard]] Vector back(const Vector& d) const {
    Vector out;
    for (int j = 0; j < 3; ++j) out[j] = row[0][j] * d[0] + row[1][j] * d[1] + row[2][j] * d[2];
    return out;
  }
  std::array<Vector, 3> row;
  Vector translation;
};

geom::Vec3 rounded(const Vector& v) {
  return {CGAL::to_double(v[0]), CGAL::to_double(v[1]), CGAL::to_double(v[2])};
}

/// The point farthest along d, exactly. Rounded products leave out most of the others.
std::uint32_t farthest(const Posed& posed, const Pose& pose, const Vector& d) {
  const Polytope& body = posed.body();
  geom::Vec3 near = rounded(d);
  const double largest = near.cwiseAbs().maxCoeff();
  // near errs by 2^-52 of its components, the products below by 7 · 2^-53 more; twice that for any
  // rounding, twice for their difference: 2^-47 is more.
  double slack = std::numeric_limits<double>::infinity();
  geom::Vec3 local = geom::Vec3::Zero();
  if (largest > 1e-200 && largest < 1e200) {
    near /= largest;
    local = posed.pose().linear.transpose() * near;
    slack = 0x1p-47 * near.cwiseAbs().dot(posed.magnitude()) + 1e-200;
  }
  const double most = body.support(local).value;
  const Vector exact_local = pose.back(d);
  std::optional<Number> best_value;
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < body.size(); ++i) {
    const geom::Vec3 p = body.point(i);
    if (local.dot(p) < most - slack) continue;
    Number value = dot(exact_local, exact(p));
    if (best_value && !(value > *best_value)) continue;
    best_value = std::move(value);
    best = i;
  }
  return best;
}

struct Corner {
  Vector w;
  std::uint32_t a, b;
};

/// A point of a simplex: numerator / denominator.
struct Nearest {
  Vector numerator;
  Number denominator;
  std::vector<Corner> corners;  ///< whose hull it is in, affinely independent
};

Number determinant(const std::vector<std::vector<Number>>& m) {
  if (m.size() == 1) return m[0][0];
  if (m.size() == 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// The point of the affine hull of some corners nearest to the origin, if it is in their hull: the
/// normal equations by Cramer's rule. nullopt also for corners that are affinely dependent.
std::optional<Nearest> nearest_of(std::vector<Corner> corners) {
  const std::size_t n = corners.size() - 1;
  Nearest out;
  if (n == 0) {
    out.numerator = corners[0].w;
    out.denominator = Number(1);
    out.corners = std::move(corners);
    return out;
  }
  std::vector<Vector> edge;
  for (std::size_t i = 1; i <= n; ++i) edge.push_back(minus(corners[i].w, corners[0].w));
  std::vector<std::vector<Number>> gram(n, std::vector<Number>(n));
  std::vector<Number> right(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) gram[i][j] = dot(edge[i], edge[j]);
    right[i] = -dot(edge[i], corners[0].w);
  }
  out.denominator = determinant(gram);
  const Number zero(0);
  if (out.denominator == zero) return std::nullopt;
  Number first = out.denominator;
  std::vector<Number> share(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::vector<Number>> replaced = gram;
    for (std::size_t j = 0; j < n; ++j) replaced[j][i] = right[j];
    share[i] = determinant(replaced);
    if (share[i] < zero) return std::nullopt;
    first = first - share[i];
  }
  if (first < zero) return std::nullopt;
  for (int k = 0; k < 3; ++k) {
    out.numerator[k] = first * corners[0].w[k];
    for (std::size_t i = 0; i < n; ++i)
      out.numerator[k] = out.numerator[k] + share[i] * corners[i + 1].w[k];
  }
  out.corners = std::move(corners);
  return out;
}

/// Whether no corner is farther towards the origin than the point.
bool is_nearest(const Nearest& point, const std::vector<Corner>& corners) {
  const Number square = dot(point.numerator, point.numerator);
  for (const Corner& c : corners)
    if (dot(point.numerator, c.w) * point.denominator < square) return false;
  return true;
}

/// Some subset gives it: the corners of the face it lies in, of these an independent one
/// (Carathéodory).
Nearest nearest_of_all(const std::vector<Corner>& corners) {
  for (unsigned subset = 1; subset < 1U << corners.size(); ++subset) {
    std::vector<Corner> chosen;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if ((subset >> i & 1U) != 0) chosen.push_back(corners[i]);
    std::optional<Nearest> point = nearest_of(std::move(chosen));
    if (point && is_nearest(*point, corners)) return *std::move(point);
  }
  throw Error(ErrorCode::Internal, "internal error: a simplex has no point nearest to the origin");
}

}  // namespace

bool are_within_exactly(const Posed& a, const Posed& b, double reach, const Simplex& start) {
  const Pose pose_a(a.pose()), pose_b(b.pose());
  const auto corner = [&](std::uint32_t i, std::uint32_t j) {
    return Corner{minus(pose_b.place(b.body().point(j)), pose_a.place(a.body().point(i))), i, j};
  };
  std::vector<Corner> corners;
  corners.reserve(5);
  for (int i = 0; i < start.size; ++i)
    corners.push_back(corner(start.vertex[i].a, start.vertex[i].b));
  if (corners.empty()) corners.push_back(corner(0, 0));
  const Number zero(0), square_reach = Number(reach) * Number(reach);
  for (;;) {
    Nearest point = nearest_of_all(corners);
    const Vector& v = point.numerator;
    const Number square = dot(v, v);
    if (!(square > square_reach * point.denominator * point.denominator)) return true;
    const Vector away{-v[0], -v[1], -v[2]};
    Corner next = corner(farthest(a, pose_a, v), farthest(b, pose_b, away));
    const Number along = dot(v, next.w);
    // All differences are at least along / |v| from the origin.
    if (along > zero && along * along > square_reach * square) return false;
    // Not nearer: the point is the nearest of all, and it is farther than the reach.
    if (!(along * point.denominator < square)) return false;
    corners = std::move(point.corners);
    corners.push_back(std::move(next));
  }
}

}  // namespace kaboum::collide::detail
