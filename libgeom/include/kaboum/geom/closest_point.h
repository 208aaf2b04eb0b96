#pragma once

#include <kaboum/geom/mesh.h>

// Points of triangles, in rounded arithmetic: for costs and fields, never for certificates, which
// take the brackets of point_triangle.h. In a header, as they are asked for millions of times.
namespace kaboum::geom {

/// A point of a triangle, and the edge beyond which lies what it is closest to.
struct ClosestPoint {
  Vec3 point;
  int beyond;  ///< the edge from corner k to k + 1; next to a corner one of two; -1: none
};

/// Point of the triangle (a, b, c) closest to p, in rounded arithmetic: for costs, never for
/// certificates. Source: [ericson2005] §5.1.5.
inline ClosestPoint closest_and_beyond(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr int kAb = 0, kBc = 1, kCa = 2;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (d1 <= 0 && d2 <= 0) return {a, vc < 0 ? kAb : kCa};
  if (d3 >= 0 && d4 <= d3) return {b, vc < 0 ? kAb : kBc};
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + (d1 > d3 ? d1 / (d1 - d3) : 0) * ab, kAb};
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (d6 >= 0 && d5 <= d6) return {c, vb < 0 ? kCa : kBc};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + (d2 > d6 ? d2 / (d2 - d6) : 0) * ac, kCa};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double sum = (d4 - d3) + (d5 - d6);
    return {b + (sum > 0 ? (d4 - d3) / sum : 0) * (c - b), kBc};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {a, -1};
  return {a + (vb / sum) * ab + (vc / sum) * ac, -1};
}

/// The same without the edge.
inline Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return closest_and_beyond(p, a, b, c).point;
}

/// Squared distance of p to the triangle (a, a + ab, a + ac) of some area, rounded, with its edges
/// at hand. Source: as above.
inline double squared_distance(const Vec3& p, const Vec3& a, const Vec3& ab, const Vec3& ac) {
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
  const double d3 = d1 - bb, d4 = d2 - bc;
  if (d3 >= 0 && d4 <= d3) return (ap - ab).squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - (d1 / (d1 - d3)) * ab).squaredNorm();
  const double d5 = d1 - bc, d6 = d2 - cc;
  if (d6 >= 0 && d5 <= d6) return (ap - ac).squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - (d2 / (d2 - d6)) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return (ap - ab - w * (ac - ab)).squaredNorm();
  }
  const double sum = va + vb + vc;
  return (ap - (vb / sum) * ab - (vc / sum) * ac).squaredNorm();
}

}  // namespace kaboum::geom
