#pragma once

#include <kaboum/geom/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kaboum::bmesh {

using geom::Vec3;

/// Where the numbers of FourTriangles are measured from, and in what: single precision then has
/// coordinates of about 1.
struct Frame {
  Vec3 origin = Vec3::Zero();
  double scale = 1;

  Frame() = default;
  explicit Frame(const geom::Box3& box) {
    if (!(box.max - box.min).allFinite()) return;
    origin = box.center();
    const double size = (box.max - box.min).maxCoeff();
    if (size > 0 && std::isfinite(1 / size)) scale = 1 / size;
  }
  [[nodiscard]] Eigen::Vector3f operator()(const Vec3& p) const {
    return ((p - origin) * scale).cast<float>();
  }
  /// A square that the rounded bounds of what is at this squared distance do not exceed.
  [[nodiscard]] float cutoff(double squared) const {
    constexpr double kRounding = 1e-6;
    const double length = std::sqrt(squared) * scale + kRounding;
    return static_cast<float>(length * length);
  }
};

/// Squared sine below which a triangle is a sliver: single precision has no normal for it.
constexpr double kSliver = 1e-10;

/// Lower bounds of the distances of four triangles from a point, found at once and in single
/// precision: for costs, never for certificates.
///
/// The heights over a triangle's plane and over the planes across its edges bound the distance, and
/// are it unless a corner is nearest.
class FourTriangles {
 public:
  /// Triangles that are not put, or have hardly any area, are at distance 0.
  void put(int worker, const std::array<Vec3, 3>& corner, const Frame& frame) {
    const Vec3 a = (corner[0] - frame.origin) * frame.scale,
               u = (corner[1] - corner[0]) * frame.scale, v = (corner[2] - corner[0]) * frame.scale;
    const Vec3 across = u.cross(v);
    const double area = across.squaredNorm();
    if (!(area > kSliver * u.squaredNorm() * v.squaredNorm())) return;
    const Vec3 normal = across / std::sqrt(area);
    const auto plane = [&](int k, const Vec3& n, const Vec3& through) {
      x_[k][worker] = static_cast<float>(n.x());
      y_[k][worker] = static_cast<float>(n.y());
      z_[k][worker] = static_cast<float>(n.z());
      offset_[k][worker] = static_cast<float>(n.dot(through));
    };
    plane(0, normal, a);
    plane(1, u.cross(normal).normalized(), a);
    plane(2, (v - u).cross(normal).normalized(), a + u);
    plane(3, normal.cross(v).normalized(), a);
  }

  /// Squares, in the frame's units.
  void at_least(const Eigen::Vector3f& p, std::array<float, 4>& squared) const {
    float height[4][4];
    for (int k = 0; k < 4; ++k)
      for (int t = 0; t < 4; ++t)
        height[k][t] = x_[k][t] * p.x() + y_[k][t] * p.y() + z_[k][t] * p.z() - offset_[k][t];
    for (int t = 0; t < 4; ++t) {
      float beside = std::max(height[1][t], height[2][t]);
      beside = std::max(beside, height[3][t]);
      beside = std::max(beside, 0.0F);
      squared[t] = height[0][t] * height[0][t] + beside * beside;
    }
  }

 private:
  // Of the planes, by triangle: its own first.
  float x_[4][4] = {}, y_[4][4] = {}, z_[4][4] = {}, offset_[4][4] = {};
};

}  // namespace kaboum::bmesh
