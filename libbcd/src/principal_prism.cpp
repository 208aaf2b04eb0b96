// Prisms round points, across the axis of least covariance.

#include "principal_prism.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kaboum::bcd {

using Eigen::Vector2d;
using geom::Vec3;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

}  // namespace

std::optional<PrincipalPrism> PrincipalPrism::round(std::span<const Vec3> points,
                                                    std::size_t most) {
  const std::optional<PrincipalBox> box = principal_box(points);
  if (!box) return std::nullopt;
  PrincipalPrism out(*box);
  std::vector<Vector2d> base;
  for (const Vec3& p : points) {
    const Vec3 q = box->axes.transpose() * (p - box->mean);
    base.emplace_back(q.y(), q.z());
  }
  out.heights_ = heights_of(base, 4);
  for (std::size_t sides = 8; sides <= 64 && 2 * sides <= most; sides *= 2) {
    std::vector<double> finer = heights_of(base, sides);
    if (area_of(finer) < 0.98 * area_of(out.heights_)) out.heights_ = std::move(finer);
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
