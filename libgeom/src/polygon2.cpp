#include <kaboum/geom/polygon2.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace kaboum::geom {
namespace {

/// Share of a length that counts as nothing.
constexpr double kEqual = 1e-9;

}  // namespace

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Polygon2 convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points, [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  Polygon2 hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= first + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

Polygon2 left_of(const Polygon2& polygon, const Vec2& from, const Vec2& along) {
  Polygon2 kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double at_p = cross(along, p - from), at_q = cross(along, q - from);
    if (at_p >= 0) kept.push_back(p);
    if ((at_p >= 0) != (at_q >= 0)) kept.emplace_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return kept;
}

Polygon2 common_part(Polygon2 a, const Polygon2& b) {
  for (std::size_t i = 0; i < b.size() && !a.empty(); ++i)
    a = left_of(a, b[i], b[(i + 1) % b.size()] - b[i]);
  return a;
}

Polygon2 eroded(const Polygon2& polygon, double by) {
  Polygon2 out = polygon;
  for (std::size_t i = 0; i < polygon.size() && !out.empty(); ++i) {
    const Vec2 along = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (!(along.norm() > 0)) continue;
    const Vec2 inwards = Vec2(-along.y(), along.x()).normalized();
    out = left_of(out, polygon[i] + by * inwards, along);
  }
  return out;
}

bool holds(const Polygon2& polygon, const Vec2& p, double inside) {
  if (polygon.size() < 3) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (cross(edge, p - polygon[i]) < inside * edge.norm()) return false;
  }
  return true;
}

/// It is least across one of the edges.
double width_of(const Polygon2& polygon) {
  if (polygon.size() < 3) return 0;
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    double low = 0, high = 0;
    for (const Vec2& p : polygon) {
      low = std::min(low, cross(edge, p - polygon[i]));
      high = std::max(high, cross(edge, p - polygon[i]));
    }
    out = std::min(out, (high - low) / edge.norm());
  }
  return out;
}

Centroid centroid_of(const Polygon2& polygon) {
  Centroid out;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area = 0.5 * cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    out.place += area / 3 * (polygon[0] + polygon[i] + polygon[i + 1]);
    out.area += area;
  }
  if (out.area > 0) out.place /= out.area;
  return out;
}

double reach_within(const Polygon2& polygon, const Vec2& from, const Vec2& along) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double falls = cross(edge, along);
    if (falls < 0) out = std::min(out, cross(edge, from - polygon[i]) / -falls);
  }
  return std::isfinite(out) ? std::max(out, 0.0) : 0;
}

Vec2 longest_edge(const Polygon2& polygon) {
  Vec2 out = Vec2::UnitX();
  double longest = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.norm() > longest * (1 + kEqual)) {
      longest = edge.norm();
      out = edge / longest;
    }
  }
  return out;
}

}  // namespace kaboum::geom
