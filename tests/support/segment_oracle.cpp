// Segments and points in a solid by brute force in rational numbers.

#include "segment_oracle.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

namespace kaboum::test {
namespace {

using Vector = std::array<mpq_class, 3>;

Vector rational(const geom::Vec3& p) {
  return {mpq_class(p.x()), mpq_class(p.y()), mpq_class(p.z())};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator*(const mpq_class& t, const Vector& a) { return {t * a[0], t * a[1], t * a[2]}; }
mpq_class dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
bool is_zero(const Vector& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

struct Facet {
  std::array<Vector, 3> corner;
  Vector normal;
  mpq_class offset;  // normal·x = offset
};

std::vector<Facet> facets_of(const geom::Mesh& mesh) {
  std::vector<Facet> out;
  for (const geom::Triangle& t : mesh.triangles) {
    Facet f{{rational(mesh.vertices[t[0]]), rational(mesh.vertices[t[1]]),
             rational(mesh.vertices[t[2]])},
            {},
            0};
    f.normal = cross(f.corner[1] - f.corner[0], f.corner[2] - f.corner[0]);
    if (is_zero(f.normal)) continue;
    f.offset = dot(f.normal, f.corner[0]);
    out.push_back(f);
  }
  return out;
}

/// Of a point off all facets.
int winding(const std::vector<Facet>& facets, const Vector& p) {
  std::mt19937 random(7);
  for (int attempt = 0; attempt < 100; ++attempt) {
    const auto number = [&] { return mpq_class(static_cast<int>(random() % 20001) - 10000); };
    const Vector d{number(), number(), number()};
    int sum = 0;
    bool good = true;
    for (const Facet& f : facets) {
      const mpq_class rise = dot(f.normal, d);
      if (rise == 0) {
        good = false;
        break;
      }
      const mpq_class t = (f.offset - dot(f.normal, p)) / rise;
      if (t < 0) continue;
      const Vector at = p + t * d;
      bool inside = true;
      for (std::size_t k = 0; k < 3 && inside; ++k) {
        const mpq_class side =
            dot(cross(f.corner[(k + 1) % 3] - f.corner[k], at - f.corner[k]), f.normal);
        if (side == 0) good = false;
        inside = side >= 0;
      }
      if (inside) sum += rise > 0 ? 1 : -1;
    }
    if (good) return sum;
  }
  throw std::logic_error("no line in general position");
}

bool point_in_solid(const Vector& p, const std::vector<Facet>& facets) {
  std::vector<Vector> planes;  // through p, of all facets, whether they hold it or not
  for (const Facet& f : facets)
    if (dot(f.normal, p) == f.offset &&
        std::none_of(planes.begin(), planes.end(),
                     [&](const Vector& n) { return is_zero(cross(n, f.normal)); }))
      planes.push_back(f.normal);
  const auto solid_at = [&](const Vector& d) {
    mpq_class nearest = 1;
    for (const Facet& f : facets) {
      const mpq_class rise = dot(f.normal, d);
      if (rise == 0) continue;
      const mpq_class t = (f.offset - dot(f.normal, p)) / rise;
      if (t > 0) nearest = std::min(nearest, t);
    }
    return winding(facets, p + (nearest / 2) * d) >= 1;
  };
  if (planes.empty()) return solid_at({mpq_class(1), mpq_class(2), mpq_class(3)});
  // Every cone is spanned by two or three of these.
  std::vector<Vector> rays;
  const auto add = [&](const Vector& v) {
    if (is_zero(v)) return;
    mpq_class most = 0;
    for (const mpq_class& x : v) most = std::max(most, mpq_class(abs(x)));
    for (const int sign : {1, -1}) {
      const Vector ray = (sign / most) * v;
      if (std::find(rays.begin(), rays.end(), ray) == rays.end()) rays.push_back(ray);
    }
  };
  std::optional<Vector> line;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      add(cross(planes[i], planes[j]));
      if (!line) line = cross(planes[i], planes[j]);
    }
  const bool one_line = !line || std::all_of(planes.begin(), planes.end(),
                                             [&](const Vector& n) { return dot(n, *line) == 0; });
  if (one_line)
    for (const Vector& n : planes) {
      add(n);
      if (line) add(cross(n, *line));
    }
  std::set<std::vector<int>> seen;
  const auto try_one = [&](const Vector& d) {
    std::vector<int> signs;
    for (const Vector& n : planes) signs.push_back(sgn(dot(n, d)));
    if (std::find(signs.begin(), signs.end(), 0) != signs.end()) return false;
    return seen.insert(signs).second && solid_at(d);
  };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (try_one(rays[i])) return true;
    for (std::size_t j = 0; j < i; ++j) {
      const Vector two = rays[i] + rays[j];
      if (try_one(two)) return true;
      for (std::size_t k = 0; k < j; ++k)
        if (try_one(two + rays[k])) return true;
    }
  }
  return false;
}

}  // namespace

bool segment_in_solid(const geom::Vec3& p, const geom::Vec3& q, const geom::Mesh& solid) {
  const std::vector<Facet> facets = facets_of(solid);
  const Vector from = rational(p), along = rational(q) - from;
  if (is_zero(along)) return point_in_solid(from, facets);
  // Where it meets any plane of a facet, or of a facet's edge across the facet.
  std::set<mpq_class> at{0, 1};
  const auto meet = [&](const Vector& normal, const Vector& on) {
    const mpq_class rise = dot(normal, along);
    if (rise == 0) return;
    const mpq_class t = dot(normal, on - from) / rise;
    if (t > 0 && t < 1) at.insert(t);
  };
  for (const Facet& f : facets) {
    meet(f.normal, f.corner[0]);
    for (std::size_t k = 0; k < 3; ++k)
      meet(cross(f.corner[(k + 1) % 3] - f.corner[k], f.normal), f.corner[k]);
  }
  for (auto next = std::next(at.begin()); next != at.end(); ++next)
    if (!point_in_solid(from + ((*std::prev(next) + *next) / 2) * along, facets)) return false;
  return true;
}

bool thin_in_solid(const geom::Mesh& mesh, const geom::Mesh& solid) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const geom::Triangle& t) {
    std::array<geom::Vec3, 3> v{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    if (!is_zero(cross(rational(v[1]) - rational(v[0]), rational(v[2]) - rational(v[0]))))
      return true;
    std::sort(v.begin(), v.end(), [](const geom::Vec3& a, const geom::Vec3& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
    return segment_in_solid(v[0], v[2], solid);
  });
}

}  // namespace kaboum::test
