// Contact of two polytopes by brute force in rational numbers.

#include "rational_contact.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

namespace kaboum::test {
namespace {

using Vector = std::array<mpq_class, 3>;

Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector along(const Vector& a, const mpq_class& t, const Vector& d) {
  return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
mpq_class dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
bool is_zero(const Vector& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

struct Body {
  Body(const geom::Mesh& mesh, const geom::Transform& pose) : triangles(mesh.triangles) {
    for (const geom::Vec3& p : mesh.vertices) {
      Vector v;
      for (int i = 0; i < 3; ++i) {
        v[i] = pose.translation[i];
        for (int j = 0; j < 3; ++j) v[i] += mpq_class(pose.linear(i, j)) * mpq_class(p[j]);
      }
      points.push_back(v);
    }
    for (const auto& t : triangles)
      for (int i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::vector<Vector> points;
  std::vector<geom::Triangle> triangles;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
};

bool separates(const Vector& d, const Body& a, const Body& b) {
  if (is_zero(d)) return false;
  const auto range = [&](const Body& body) {
    std::pair<mpq_class, mpq_class> r(dot(d, body.points[0]), dot(d, body.points[0]));
    for (const Vector& p : body.points) {
      const mpq_class at = dot(d, p);
      r.first = std::min(r.first, at);
      r.second = std::max(r.second, at);
    }
    return r;
  };
  const auto [a_low, a_high] = range(a);
  const auto [b_low, b_high] = range(b);
  return a_high < b_low || b_high < a_low;
}

bool meet(const Body& a, const Body& b) {
  for (const Body* body : {&a, &b})
    for (const auto& [i, j, k] : body->triangles)
      if (separates(cross(body->points[j] - body->points[i], body->points[k] - body->points[i]), a,
                    b))
        return false;
  for (const auto& [i, j] : a.edges)
    for (const auto& [k, l] : b.edges)
      if (separates(cross(a.points[j] - a.points[i], b.points[l] - b.points[k]), a, b))
        return false;
  return true;
}

mpq_class square(const Vector& v) { return dot(v, v); }

mpq_class to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector d = b - a;
  mpq_class t = dot(p - a, d) / square(d);
  if (t < 0) t = 0;
  if (t > 1) t = 1;
  return square(p - along(a, t, d));
}

mpq_class to_triangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector n = cross(b - a, c - a);
  const bool above = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                     dot(cross(a - c, p - c), n) >= 0;
  if (above) {
    const mpq_class height = dot(p - a, n);
    return height * height / square(n);
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

/// Where the nearest points are inside of both; the ends are the vertices' business.
mpq_class between_lines(const Vector& a, const Vector& b, const Vector& c, const Vector& d,
                        const mpq_class& otherwise) {
  const Vector u = b - a, v = d - c, w = a - c;
  const mpq_class uu = square(u), uv = dot(u, v), vv = square(v), uw = dot(u, w), vw = dot(v, w);
  const mpq_class det = uu * vv - uv * uv;
  if (det == 0) return otherwise;
  const mpq_class s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
  if (s < 0 || s > 1 || t < 0 || t > 1) return otherwise;
  return square(along(a, s, u) - along(c, t, v));
}

mpq_class square_distance(const Body& a, const Body& b) {
  mpq_class least = square(a.points[0] - b.points[0]);
  const auto points_to = [&](const Body& x, const Body& y) {
    for (const Vector& p : x.points)
      for (const auto& [i, j, k] : y.triangles)
        least = std::min(least, to_triangle(p, y.points[i], y.points[j], y.points[k]));
  };
  points_to(a, b);
  points_to(b, a);
  for (const auto& [i, j] : a.edges)
    for (const auto& [k, l] : b.edges)
      least =
          std::min(least, between_lines(a.points[i], a.points[j], b.points[k], b.points[l], least));
  return least;
}

}  // namespace

bool rational_within(const geom::Mesh& a, const geom::Transform& pose_a, const geom::Mesh& b,
                     const geom::Transform& pose_b, double reach) {
  const Body x(a, pose_a), y(b, pose_b);
  if (meet(x, y)) return true;
  return reach > 0 && square_distance(x, y) <= mpq_class(reach) * mpq_class(reach);
}

}  // namespace kaboum::test
