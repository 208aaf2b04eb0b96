#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace kaboum::geom {

/// Four numbers that are computed with at once. Operations round as those of single numbers do.
using Float4 = float __attribute__((vector_size(16)));

/// The larger ones. @pre none is NaN
inline Float4 larger(const Float4& a, const Float4& b) {
#ifdef __SSE__
  return _mm_max_ps(b, a);
#else
  return a < b ? b : a;
#endif
}

/// Bit i: whether the i-th is below the limit.
inline unsigned bits_below(const Float4& x, float limit) {
#ifdef __SSE__
  return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(x, _mm_set1_ps(limit))));
#else
  const auto below = std::bit_cast<std::array<std::uint64_t, 2>>(x < limit);
  constexpr auto pair = [](std::uint64_t two) {
    return static_cast<unsigned>((two & 1U) | (two >> 62U & 2U));
  };
  return pair(below[0]) | pair(below[1]) << 2U;
#endif
}

/// Where the numbers of FourTriangles are measured from, and in what: single precision then has
/// coordinates of about 1.
struct UnitFrame {
  Vec3 origin = Vec3::Zero();
  double scale = 1;

  UnitFrame() = default;
  explicit UnitFrame(const Box3& box) {
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
  void put(int worker, const std::array<Vec3, 3>& corner, const UnitFrame& frame) {
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
  [[nodiscard]] Float4 at_least(const Eigen::Vector3f& p) const {
    const auto height = [&](int k) {
      return x_[k] * p.x() + y_[k] * p.y() + z_[k] * p.z() - offset_[k];
    };
    const Float4 above = height(0);
    const Float4 beside = larger(larger(larger(height(1), height(2)), height(3)), Float4{});
    return above * above + beside * beside;
  }

 private:
  // Of the planes, by triangle: its own first.
  std::array<Float4, 4> x_{}, y_{}, z_{}, offset_{};
};

}  // namespace kaboum::geom
