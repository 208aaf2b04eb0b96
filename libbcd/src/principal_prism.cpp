// Prisms round points, across the axis of least covariance or the normal of a facet.

#include "principal_prism.h"

#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kaboum::bcd {

using Eigen::Vector2d;
using geom::Vec3;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Another base, or other axes, have to be smaller than this share to be taken.
constexpr double kSmaller = 0.98;
/// Triangles of a hull that are looked at, the largest; facets of them that prisms are tried
/// across; edges of an outline that these are tried along. Triangles with nearly the same normal
/// are one facet.
constexpr std::size_t kMostTriangles = 96, kMostFacets = 12, kMostEdges = 32;
constexpr double kSameNormal = 1 - 1e-6;

Vector2d normal_of(std::size_t side, std::size_t sides) {
  const double angle =
      2 * std::numbers::pi * static_cast<double>(side) / static_cast<double>(sides);
  return {std::cos(angle), std::sin(angle)};
}

/// How far the points reach in the direction of every side. All sides touch them, so consecutive
/// ones meet in the corners of the polygon that they bound.
std::vector<double> heights_of(const std::vector<Vector2d>& points, std::size_t sides) {
  std::vector<double> out;
  for (std::size_t i = 0; i < sides; ++i) {
    const Vector2d n = normal_of(i, sides);
    double height = -kInfinity;
    for (const Vector2d& p : points) height = std::max(height, n.dot(p));
    out.push_back(height);
  }
  return out;
}

std::vector<Vector2d> polygon_of(const std::vector<double>& heights, double margin) {
  std::vector<Vector2d> out;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::size_t j = (i + 1) % heights.size();
    const Vector2d m = normal_of(i, heights.size()), n = normal_of(j, heights.size());
    const double g = heights[i] + margin, h = heights[j] + margin;
    out.emplace_back(Vector2d(g * n.y() - h * m.y(), h * m.x() - g * n.x()) /
                     (m.x() * n.y() - m.y() * n.x()));
  }
  return out;
}

double area_of(const std::vector<double>& heights) {
  const std::vector<Vector2d> polygon = polygon_of(heights, 0);
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// Normals of the largest facets of a hull.
std::vector<Vec3> main_normals(const geom::Mesh& hull) {
  std::vector<Vec3> doubled;  // of triangles: normals as long as twice the area
  doubled.reserve(hull.triangles.size());
  for (const geom::Triangle& t : hull.triangles) {
    const Vec3& a = hull.vertices[t[0]];
    doubled.push_back((hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a));
  }
  const auto longer = [](const Vec3& a, const Vec3& b) {
    return a.squaredNorm() > b.squaredNorm();
  };
  std::stable_sort(doubled.begin(), doubled.end(), longer);
  if (doubled.size() > kMostTriangles) doubled.resize(kMostTriangles);
  std::vector<Vec3> out;
  for (const Vec3& m : doubled) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Vec3& n) {
      return n.dot(m) > kSameNormal * n.norm() * m.norm();
    });
    if (same == out.end()) {
      out.push_back(m);
    } else {
      *same += m;
    }
  }
  std::stable_sort(out.begin(), out.end(), longer);
  if (out.size() > kMostFacets) out.resize(kMostFacets);
  return out;
}

/// The corners of the hull of points in a plane, in order.
std::vector<Vector2d> outline_of(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vector2d> out;
  for (const bool upper : {false, true}) {
    const std::size_t first = out.size();
    for (const Vector2d& p : points) {
      while (out.size() >= first + 2) {
        const Vector2d a = out[out.size() - 2], u = out.back() - a, w = p - a;
        if (u.x() * w.y() - u.y() * w.x() > 0) break;
        out.pop_back();
      }
      out.push_back(p);
    }
    out.pop_back();  // it is the first of the other half
    if (!upper) std::reverse(points.begin(), points.end());
  }
  return out;
}

/// Axes of the smallest box across a direction: the first is the direction, the second along an
/// edge of the points' outline. Nothing where the direction has no length.
std::optional<Eigen::Matrix3d> axes_across(const std::vector<Vec3>& points, const Vec3& direction) {
  if (!(direction.norm() > 0)) return std::nullopt;
  const Vec3 n = direction.normalized(), u = n.unitOrthogonal(), w = n.cross(u);
  std::vector<Vector2d> flat;
  flat.reserve(points.size());
  for (const Vec3& p : points) flat.emplace_back(u.dot(p), w.dot(p));
  const std::vector<Vector2d> outline = outline_of(std::move(flat));
  std::vector<Vector2d> edges;
  edges.reserve(outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i)
    edges.emplace_back(outline[(i + 1) % outline.size()] - outline[i]);
  std::stable_sort(edges.begin(), edges.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.squaredNorm() > b.squaredNorm();
  });
  if (edges.size() > kMostEdges) edges.resize(kMostEdges);
  double least = kInfinity;
  std::optional<Eigen::Matrix3d> out;
  for (const Vector2d& edge : edges) {
    if (!(edge.norm() > 0)) continue;
    const Vector2d along = edge.normalized(), across(-along.y(), along.x());
    Vector2d low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
    for (const Vector2d& p : outline) {
      const Vector2d q(along.dot(p), across.dot(p));
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    const double area = (high - low).prod();
    if (!(area < least)) continue;
    least = area;
    out.emplace();
    *out << n, along.x() * u + along.y() * w, across.x() * u + across.y() * w;
  }
  return out;
}

}  // namespace

PrincipalPrism::PrincipalPrism(std::span<const Vec3> points, const PrincipalBox& box,
                               std::size_t most)
    : box_(box) {
  std::vector<Vector2d> base;
  base.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 q = box.axes.transpose() * (p - box.mean);
    base.emplace_back(q.y(), q.z());
  }
  heights_ = heights_of(base, 4);
  for (std::size_t sides = 8; sides <= 64 && 2 * sides <= most; sides *= 2) {
    std::vector<double> finer = heights_of(base, sides);
    if (area_of(finer) < kSmaller * area_of(heights_)) heights_ = std::move(finer);
  }
}

double PrincipalPrism::volume() const { return (box_.high.x() - box_.low.x()) * area_of(heights_); }

std::optional<PrincipalPrism> PrincipalPrism::round(std::span<const Vec3> points,
                                                    std::size_t most) {
  const std::optional<PrincipalBox> box = principal_box(points);
  if (!box) return std::nullopt;
  PrincipalPrism out(points, *box, most);
  geom::HullBuilder builder;
  if (!builder.build(points)) return out;
  const geom::Mesh hull = builder.mesh();
  for (const Vec3& normal : main_normals(hull)) {
    const std::optional<Eigen::Matrix3d> axes = axes_across(hull.vertices, normal);
    if (!axes) continue;
    PrincipalPrism other(points, box_along(points, *axes), most);
    if (other.volume() < kSmaller * out.volume()) out = std::move(other);
  }
  return out;
}

std::vector<Vec3> PrincipalPrism::corners(double margin) const {
  std::vector<Vec3> out;
  for (const Vector2d& c : polygon_of(heights_, margin))
    for (const double x : {box_.low.x() - margin, box_.high.x() + margin})
      out.emplace_back(box_.mean + box_.axes * Vec3(x, c.x(), c.y()));
  return out;
}

}  // namespace kaboum::bcd
