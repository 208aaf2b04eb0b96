// Balls and solids by brute force in rational numbers.
#include "ball_oracle.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <optional>

#include "oracle.h"

namespace kaboum::test {
namespace {

using Vector = std::array<mpq_class, 3>;

Vector vector_of(const geom::Vec3& p) { return {p[0], p[1], p[2]}; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
mpq_class dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

mpq_class square_to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector d = minus(b, a), w = minus(p, a);
  const mpq_class length = dot(d, d);
  mpq_class t = length == 0 ? mpq_class(0) : mpq_class(dot(w, d) / length);
  t = std::clamp(t, mpq_class(0), mpq_class(1));
  const Vector off{w[0] - t * d[0], w[1] - t * d[1], w[2] - t * d[2]};
  return dot(off, off);
}

/// By the weights of the foot of the perpendicular, where all of them are ≥ 0; else by the sides.
mpq_class square_to_triangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector u = minus(b, a), v = minus(c, a), w = minus(p, a);
  const mpq_class uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  if (const mpq_class gram = uu * vv - uv * uv; gram > 0) {
    const mpq_class s = (vv * wu - uv * wv) / gram, t = (uu * wv - uv * wu) / gram;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      const Vector off{w[0] - s * u[0] - t * v[0], w[1] - s * u[1] - t * v[1],
                       w[2] - s * u[2] - t * v[2]};
      return dot(off, off);
    }
  }
  return std::min(
      {square_to_segment(p, a, b), square_to_segment(p, b, c), square_to_segment(p, c, a)});
}

}  // namespace

int compare_distance(const geom::Mesh& mesh, const geom::Vec3& p, double length) {
  std::optional<mpq_class> least;
  const Vector at = vector_of(p);
  for (const auto& [i, j, k] : mesh.triangles) {
    const mpq_class square = square_to_triangle(
        at, vector_of(mesh.vertices[i]), vector_of(mesh.vertices[j]), vector_of(mesh.vertices[k]));
    if (!least || square < *least) least = square;
  }
  const mpq_class bound(length);
  return cmp(*least, mpq_class(bound * bound));
}

bool is_in_ball(const geom::Vec3& center, double radius, const geom::Vec3& p) {
  const Vector d = minus(vector_of(p), vector_of(center));
  const mpq_class r(radius);
  return dot(d, d) <= r * r;
}

bool is_ball_in_solid(const geom::Mesh& mesh, const geom::Vec3& center, double radius) {
  const std::optional<int> winding = winding_number_slow(mesh, center);
  return winding && *winding >= 1 && compare_distance(mesh, center, radius) >= 0;
}

}  // namespace kaboum::test
