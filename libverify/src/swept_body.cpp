// Distances of points from a convex body, with planes from exact products.
// docs/algorithms/swept-volumes.md, "Planes". Closest points: [ericson2005], 5.1.5.
#include "swept_body.h"

#include <algorithm>
#include <cmath>

#include "number.h"

namespace kaboum::verify {

using geom::Vec3;

namespace {

/// A point of the triangle, the nearest to p but for rounding [ericson2005]; whatever rounding
/// chooses, the weights are those of a convex combination. Not closest_point of nearest.h, which
/// takes the triangle's normal and so more than twice the time where, as here, most triangles of a
/// body are asked for each point.
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const auto share = [](double x, double y) { return std::clamp(x / (x + y), 0.0, 1.0); };
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + share(d1, -d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + share(d2, -d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + share(d4 - d3, d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;
  const double v = std::clamp(vb / sum, 0.0, 1.0);
  return a + v * ab + std::clamp(vc / sum, 0.0, 1 - v) * ac;
}

}  // namespace

// The plane: docs/algorithms/swept-volumes.md, "Planes". Explicit margins make facets long and
// thin, down to corners in a line but for the last bits of float32; only exact products tell their
// normals.
void SweptBody::set_plane(Facet& f) {
  Triple<Exact> ab, ac;
  for (int i = 0; i < 3; ++i) {
    ab[i] = difference<Exact>(f.b[i], f.a[i]);
    ac[i] = difference<Exact>(f.c[i], f.a[i]);
  }
  Eigen::Matrix<long double, 3, 1> normal;  // whose squares do not underflow
  double error = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Approx x = rounded(ab[j] * ac[k] - ab[k] * ac[j]);
    normal[i] = x.value;
    error += x.error;
  }
  const long double area = normal.norm();
  if (!(error < area)) return;  // without area, or beyond the range of double
  f.normal = (normal / area).cast<double>();
  f.offset = f.normal.dot(f.a);
  f.slack = 0x1p-48 + 8 * static_cast<double>(error / area);
}

SweptBody::SweptBody(const geom::Mesh& hull) : vertices_(hull.vertices) {
  for (const Vec3& v : vertices_) {
    box_.extend(v);
    size_ = std::max(size_, v.cwiseAbs().maxCoeff());
  }
  facets_.reserve(hull.triangles.size());
  for (const geom::Triangle& t : hull.triangles) {
    Facet f;
    f.a = vertices_[t[0]];
    f.b = vertices_[t[1]];
    f.c = vertices_[t[2]];
    set_plane(f);
    facets_.push_back(f);
  }
  for (std::size_t i = 0; i < facets_.size(); i += 2) {
    const Facet &a = facets_[i], &b = facets_[std::min(i + 1, facets_.size() - 1)];
    planes_.push_back(Planes{Pair{a.normal.x(), b.normal.x()}, Pair{a.normal.y(), b.normal.y()},
                             Pair{a.normal.z(), b.normal.z()}, Pair{a.offset, b.offset},
                             Pair{a.slack, b.slack}});
  }
}

SweptBody::Place SweptBody::place(const Vec3& p) const {
  const double size = std::max(size_, p.cwiseAbs().maxCoeff());
  return Place{Pair{p.x(), p.x()}, Pair{p.y(), p.y()}, Pair{p.z(), p.z()}, Pair{size, size}};
}

SweptBody::Pair SweptBody::height(const Planes& planes, const Place& at) {
  return planes.x * at.x + (planes.y * at.y + planes.z * at.z) - planes.offset;
}

bool SweptBody::is_inside(const Place& at) const {
  return std::all_of(planes_.begin(), planes_.end(), [&](const Planes& planes) {
    const auto below = height(planes, at) + planes.slack * at.size <= Pair{};
    return (below[0] & below[1]) != 0;
  });
}

double SweptBody::rounding(const Vec3& p) const {
  return 0x1p-46 * std::max(size_, p.cwiseAbs().maxCoeff());
}

bool SweptBody::holds(const Vec3& p, double distance) const {
  const Place at = place(p);
  const double least = std::min(distance, 0.0);
  const Pair most{distance, distance}, deep{least, least};
  auto inside = most == most;
  for (const Planes& planes : planes_) {
    const Pair h = height(planes, at), slack = planes.slack * at.size;
    const auto beyond = h - slack > most;
    if ((beyond[0] | beyond[1]) != 0) return false;
    inside &= h + slack <= deep;
  }
  if ((inside[0] & inside[1]) != 0) return true;
  return distance > 0 && distance_from_above(p) <= distance;
}

bool SweptBody::is_beyond(const Vec3& p, double distance) const {
  const Place at = place(p);
  const Pair most{distance, distance};
  return std::any_of(planes_.begin(), planes_.end(), [&](const Planes& planes) {
    const auto beyond = height(planes, at) - planes.slack * at.size > most;
    return (beyond[0] | beyond[1]) != 0;
  });
}

Vec3 SweptBody::nearest(const Vec3& p) const {
  const double size = std::max(size_, p.cwiseAbs().maxCoeff());
  double least = std::numeric_limits<double>::infinity();
  Vec3 best = vertices_.front();
  for (const Facet& f : facets_) {
    if (f.normal.dot(p) - f.offset < -f.slack * size) continue;  // seen from behind
    const Vec3 q = nearest_in_triangle(p, f.a, f.b, f.c);
    const double d = (p - q).squaredNorm();
    if (d < least) {
      least = d;
      best = q;
    }
  }
  return best;
}

double SweptBody::distance_from_above(const Vec3& p) const {
  if (is_inside(place(p))) return 0;
  return (p - nearest(p)).norm() + rounding(p);
}

double SweptBody::distance_from_below(const Vec3& p) const {
  const Vec3 way = p - nearest(p);
  const double length = way.norm();
  if (!(length > 0)) return 0;
  const Vec3 n = way / length;
  // Of all vertices, and so of the body, none is higher than `top` along n.
  double top = -std::numeric_limits<double>::infinity();
  for (const Vec3& v : vertices_) top = std::max(top, n.dot(v));
  return std::max(0.0, n.dot(p) - top - rounding(p));
}

}  // namespace kaboum::verify
