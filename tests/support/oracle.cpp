#include "oracle.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace kaboum::test {
namespace {

using Exact = std::array<mpz_class, 3>;
using Key = std::tuple<double, double, double>;

Key key(const geom::Vec3& p) { return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}; }

/// Exponent of the lowest bit of x.
int lowest_bit(double x) {
  if (x == 0) return 1100;
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);  // x = fraction · 2^exponent
  auto digits = static_cast<long long>(std::ldexp(fraction, 53));
  exponent -= 53;
  while (digits % 2 == 0) {
    digits /= 2;
    ++exponent;
  }
  return exponent;
}

/// Turns doubles into integers by one common power of two.
class Scale {
 public:
  void see(const geom::Vec3& p) {
    for (int k = 0; k < 3; ++k) exponent_ = std::min(exponent_, lowest_bit(p[k]));
  }
  [[nodiscard]] Exact operator()(const geom::Vec3& p) const {
    Exact result;
    for (int k = 0; k < 3; ++k) {
      if (p[k] == 0) continue;
      const int low = lowest_bit(p[k]);
      result[k] = mpz_class(static_cast<double>(std::ldexp(p[k], -low)));
      result[k] <<= static_cast<unsigned long>(low - exponent_);
    }
    return result;
  }

 private:
  int exponent_ = 1100;
};

/// Sign of the determinant of (b − a, c − a, d − a): +1 when d is on the side from which a, b, c
/// appear counter-clockwise.
int side(const Exact& a, const Exact& b, const Exact& c, const Exact& d) {
  const mpz_class bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
  const mpz_class cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
  const mpz_class dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
  const mpz_class det =
      dx * (by * cz - bz * cy) + dy * (bz * cx - bx * cz) + dz * (bx * cy - by * cx);
  return sgn(det);
}

/// Twice the triangle's vector area.
Exact normal(const Exact& a, const Exact& b, const Exact& c) {
  Exact u, v, n;
  for (int k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  for (int k = 0; k < 3; ++k)
    n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
  return n;
}

bool is_zero(const Exact& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// Side of c of the line a → b, in the projection along `axis`.
int side2(const Exact& a, const Exact& b, const Exact& c, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const mpz_class det = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
  return sgn(det);
}

/// Whether p lies in the closed triangle, which may be degenerate.
/// @pre p is in the plane of a, b, c.
bool in_triangle(const Exact& p, const Exact& a, const Exact& b, const Exact& c) {
  const Exact n = normal(a, b, c);
  if (!is_zero(n)) {
    const int axis = n[0] != 0 ? 0 : (n[1] != 0 ? 1 : 2);
    const int s = side2(a, b, p, axis), t = side2(b, c, p, axis), u = side2(c, a, p, axis);
    return (s >= 0 && t >= 0 && u >= 0) || (s <= 0 && t <= 0 && u <= 0);
  }
  // A segment or a point: collinear with, and between the ends of, one of its sides.
  const std::array<const Exact*, 3> corner{&a, &b, &c};
  for (int i = 0; i < 3; ++i) {
    const Exact &e = *corner[i], &f = *corner[(i + 1) % 3];
    if (!is_zero(normal(e, f, p))) continue;
    bool between = true;
    for (int k = 0; k < 3; ++k) {
      between = between && p[k] >= std::min(e[k], f[k]) && p[k] <= std::max(e[k], f[k]);
    }
    if (between && (p == e || p == f || e != f)) return true;
  }
  return false;
}

std::vector<Exact> exact_vertices(const geom::Mesh& mesh, const Scale& scale) {
  std::vector<Exact> result;
  result.reserve(mesh.vertices.size());
  for (const geom::Vec3& p : mesh.vertices) result.push_back(scale(p));
  return result;
}

Scale scale_of(const geom::Mesh& mesh) {
  Scale scale;
  for (const geom::Vec3& p : mesh.vertices) scale.see(p);
  return scale;
}

/// Signed count of the tetrahedra (reference, t) that contain p; nullopt if p is on the border of
/// one of them.
std::optional<int> count_tetrahedra(const geom::Mesh& mesh, const std::vector<Exact>& x,
                                    const Exact& p, const Exact& reference) {
  int count = 0;
  for (const geom::Triangle& t : mesh.triangles) {
    const Exact &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    const int s0 = side(a, b, c, p);
    if (s0 == 0) continue;  // p is no inner point of this tetrahedron
    const int orientation = side(a, b, c, reference);
    if (orientation == 0 || orientation != s0) continue;
    const int s1 = side(reference, b, a, p), s2 = side(reference, c, b, p);
    if (s1 == -orientation || s2 == -orientation) continue;
    const int s3 = side(reference, a, c, p);
    if (s3 == -orientation) continue;
    if (s1 == 0 || s2 == 0 || s3 == 0) return std::nullopt;
    count -= orientation;
  }
  return count;
}

/// Whether the closed segment e–f meets the closed triangle in a point that is not a corner shared
/// by both. @pre not all five points are coplanar.
bool segment_pierces(const Exact& e, const Exact& f, const Exact& a, const Exact& b,
                     const Exact& c) {
  const int se = side(a, b, c, e), sf = side(a, b, c, f);
  if (se * sf > 0) return false;
  const auto is_corner = [&](const Exact& p) { return p == a || p == b || p == c; };
  if (se == 0) return !is_corner(e) && in_triangle(e, a, b, c);
  if (sf == 0) return !is_corner(f) && in_triangle(f, a, b, c);
  const int s = side(e, f, a, b), t = side(e, f, b, c), u = side(e, f, c, a);
  return (s >= 0 && t >= 0 && u >= 0) || (s <= 0 && t <= 0 && u <= 0);
}

/// Coplanar triangles: whether they share more than common corners and edges.
bool overlap_in_plane(const std::array<const Exact*, 3>& s, const std::array<const Exact*, 3>& t,
                      int axis) {
  const auto orient = [&](const std::array<const Exact*, 3>& q) {
    return side2(*q[0], *q[1], *q[2], axis);
  };
  std::array<const Exact*, 3> p = s, q = t;
  if (orient(p) < 0) std::swap(p[1], p[2]);
  if (orient(q) < 0) std::swap(q[1], q[2]);
  // Separated, touching allowed, by a side of either?
  const auto separated = [&](const auto& from, const auto& what) {
    for (int i = 0; i < 3; ++i) {
      bool outside = true;
      for (int k = 0; k < 3; ++k) {
        outside = outside && side2(*from[i], *from[(i + 1) % 3], *what[k], axis) <= 0;
      }
      if (outside) return true;
    }
    return false;
  };
  if (!separated(p, q) && !separated(q, p)) return true;
  // Interiors disjoint: a corner inside the other's side is still a fault (T-junction).
  for (int i = 0; i < 3; ++i) {
    const auto corner = [](const Exact& x, const std::array<const Exact*, 3>& of) {
      return x == *of[0] || x == *of[1] || x == *of[2];
    };
    if (!corner(*p[i], q) && in_triangle(*p[i], *q[0], *q[1], *q[2])) return true;
    if (!corner(*q[i], p) && in_triangle(*q[i], *p[0], *p[1], *p[2])) return true;
  }
  return false;
}

bool triangles_cross(const std::array<const Exact*, 3>& s, const std::array<const Exact*, 3>& t) {
  std::array<int, 3> above{};
  for (int i = 0; i < 3; ++i) above[i] = side(*t[0], *t[1], *t[2], *s[i]);
  if (above[0] == above[1] && above[1] == above[2]) {
    if (above[0] != 0) return false;
    const Exact n = normal(*t[0], *t[1], *t[2]);
    return overlap_in_plane(s, t, n[0] != 0 ? 0 : (n[1] != 0 ? 1 : 2));
  }
  // Sides in the other's plane are covered by the other triangle's sides and the corners on them.
  for (int i = 0; i < 3; ++i) {
    const Exact &e = *s[i], &f = *s[(i + 1) % 3];
    if (above[i] == 0 && above[(i + 1) % 3] == 0) {
      const auto corner = [&](const Exact& x) { return x == *t[0] || x == *t[1] || x == *t[2]; };
      if (!corner(e) && in_triangle(e, *t[0], *t[1], *t[2])) return true;
      if (!corner(f) && in_triangle(f, *t[0], *t[1], *t[2])) return true;
      const Exact n = normal(*t[0], *t[1], *t[2]);
      const int axis = n[0] != 0 ? 0 : (n[1] != 0 ? 1 : 2);
      for (int k = 0; k < 3; ++k) {
        const Exact &g = *t[k], &h = *t[(k + 1) % 3];
        if (side2(e, f, g, axis) * side2(e, f, h, axis) < 0 &&
            side2(g, h, e, axis) * side2(g, h, f, axis) < 0) {
          return true;
        }
      }
      continue;
    }
    if (segment_pierces(e, f, *t[0], *t[1], *t[2])) {
      // A shared corner is the only allowed meeting; segment_pierces has excluded it at the ends.
      return true;
    }
  }
  for (int i = 0; i < 3; ++i) {
    const Exact &e = *t[i], &f = *t[(i + 1) % 3];
    const int se = side(*s[0], *s[1], *s[2], e), sf = side(*s[0], *s[1], *s[2], f);
    if (se == 0 && sf == 0) continue;
    if (segment_pierces(e, f, *s[0], *s[1], *s[2])) return true;
  }
  return false;
}

}  // namespace

std::optional<int> winding_number_slow(const geom::Mesh& mesh, const geom::Vec3& p) {
  Scale scale = scale_of(mesh);
  scale.see(p);
  const std::vector<Exact> x = exact_vertices(mesh, scale);
  const Exact q = scale(p);
  mpz_class extent = 1;
  for (const geom::Triangle& t : mesh.triangles) {
    for (const std::uint32_t c : t) {
      for (int k = 0; k < 3; ++k) extent = std::max<mpz_class>(extent, abs(x[c][k] - q[k]));
    }
    const Exact &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    if (side(a, b, c, q) == 0 && in_triangle(q, a, b, c)) return std::nullopt;
  }
  std::mt19937 random(20240229);
  for (int attempt = 0; attempt < 64; ++attempt) {
    Exact reference;
    for (int k = 0; k < 3; ++k) {
      const auto digits = static_cast<long>(random() % 2000003) - 1000001;
      reference[k] = q[k] + extent * digits / 250007 + static_cast<long>(random() % 1009);
    }
    if (const auto count = count_tetrahedra(mesh, x, q, reference)) return count;
  }
  throw std::logic_error("no reference point in general position");
}

bool closed_chain(const geom::Mesh& mesh) {
  std::map<std::pair<Key, Key>, long> chain;
  for (const geom::Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Key a = key(mesh.vertices.at(t[i])), b = key(mesh.vertices.at(t[(i + 1) % 3]));
      if (a < b) ++chain[{a, b}];
      if (b < a) --chain[{b, a}];
    }
  }
  return std::all_of(chain.begin(), chain.end(), [](const auto& e) { return e.second == 0; });
}

bool closed_manifold(const geom::Mesh& mesh) {
  std::map<std::pair<Key, Key>, int> directed;
  std::map<Key, std::map<Key, Key>> link;  // vertex → the side opposite to it, of each triangle
  for (const geom::Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Key a = key(mesh.vertices.at(t[i]));
      const Key b = key(mesh.vertices.at(t[(i + 1) % 3]));
      const Key c = key(mesh.vertices.at(t[(i + 2) % 3]));
      if (a == b || ++directed[{a, b}] > 1) return false;
      link[a][b] = c;
    }
  }
  for (const auto& [edge, count] : directed) {
    if (directed.count({edge.second, edge.first}) == 0) return false;
  }
  for (const auto& [vertex, next] : link) {
    std::size_t length = 0;
    Key at = next.begin()->first;
    do {
      at = next.at(at);
      ++length;
    } while (at != next.begin()->first);
    if (length != next.size()) return false;
  }
  return true;
}

bool exactly_convex(const geom::Mesh& mesh) {
  const std::vector<Exact> x = exact_vertices(mesh, scale_of(mesh));
  for (const geom::Triangle& t : mesh.triangles) {
    for (const Exact& p : x) {
      if (side(x[t[0]], x[t[1]], x[t[2]], p) > 0) return false;
    }
  }
  return true;
}

std::size_t self_intersections(const geom::Mesh& mesh, std::size_t limit) {
  const std::vector<Exact> x = exact_vertices(mesh, scale_of(mesh));
  struct Entry {
    std::array<const Exact*, 3> corners;
    geom::Vec3 min, max;
  };
  std::vector<Entry> entries;
  for (const geom::Triangle& t : mesh.triangles) {
    const Exact &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    if (is_zero(normal(a, b, c))) continue;
    const geom::Vec3 &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
    entries.push_back({{&a, &b, &c}, p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r)});
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& l, const Entry& r) { return l.min.x() < r.min.x(); });
  std::size_t found = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size() && entries[j].min.x() <= entries[i].max.x();
         ++j) {
      const Entry &s = entries[i], &t = entries[j];
      if ((s.min.array() > t.max.array()).any() || (t.min.array() > s.max.array()).any()) continue;
      if (triangles_cross(s.corners, t.corners) && ++found >= limit) return found;
    }
  }
  return found;
}

double share_beyond_float(const geom::Mesh& mesh) {
  std::size_t beyond = 0, all = 0;
  for (const geom::Triangle& t : mesh.triangles) {
    for (const std::uint32_t c : t) {
      for (int k = 0; k < 3; ++k) {
        const double value = mesh.vertices[c][k];
        beyond += static_cast<double>(static_cast<float>(value)) != value ? 1 : 0;
        ++all;
      }
    }
  }
  return all == 0 ? 0 : static_cast<double>(beyond) / static_cast<double>(all);
}

}  // namespace kaboum::test
