#pragma once

#include <kaboum/kinematics/constraint.h>

#include <cmath>
#include <random>

namespace kaboum::test {

/// A disc, or a polygon with corners on an ellipse, in a plane at random.
inline kinematics::Surface random_surface(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  kinematics::Surface out;
  out.position = size * geom::Vec3(normal(random), normal(random), normal(random));
  out.normal = geom::Vec3(normal(random), normal(random), normal(random)).normalized();
  out.radius = size * (0.2 + unit(random));
  if (random() % 3 == 0) return out;
  const geom::Vec3 x = out.normal.unitOrthogonal(), y = out.normal.cross(x);
  const auto corners = 3 + random() % 5;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::acos(-1.0) * (static_cast<double>(i) + 0.6 * unit(random)) /
                         static_cast<double>(corners);
    out.outline.push_back(out.position + out.radius * std::cos(angle) * x +
                          0.6 * out.radius * std::sin(angle) * y);
  }
  out.radius = 0;
  return out;
}

/// Distance of a point from a surface, raised along its normal: of a disc by Pythagoras, of an
/// outline the least over the triangles of a fan, each by its barycentric coordinates or its sides.
template <typename Scalar>
Scalar distance_from_surface(const kinematics::Surface& s, const Eigen::Matrix<Scalar, 3, 1>& point,
                             Scalar raised) {
  using V = Eigen::Matrix<Scalar, 3, 1>;
  const V n = s.normal.cast<Scalar>(), p = point - raised * n;
  if (s.outline.empty()) {
    const V off = p - s.position.cast<Scalar>();
    const Scalar above = off.dot(n), across = (off - above * n).norm();
    return std::hypot(above, std::max(Scalar(0), across - Scalar(s.radius)));
  }
  const auto from_segment = [&](const V& a, const V& b) {
    const Scalar share =
        std::min(Scalar(1), std::max(Scalar(0), (p - a).dot(b - a) / (b - a).squaredNorm()));
    return (a + share * (b - a) - p).norm();
  };
  Scalar least = std::numeric_limits<Scalar>::infinity();
  for (std::size_t i = 1; i + 1 < s.outline.size(); ++i) {
    const V a = s.outline[0].cast<Scalar>(), b = s.outline[i].cast<Scalar>(),
            c = s.outline[i + 1].cast<Scalar>();
    const V up = (b - a).cross(c - a);
    const Scalar whole = up.squaredNorm();
    const Scalar u = (c - b).cross(p - b).dot(up) / whole, v = (a - c).cross(p - c).dot(up) / whole;
    if (u >= 0 && v >= 0 && u + v <= 1)
      least = std::min(least, std::abs((p - a).dot(up)) / std::sqrt(whole));
    least = std::min({least, from_segment(a, b), from_segment(b, c), from_segment(c, a)});
  }
  return least;
}

}  // namespace kaboum::test
