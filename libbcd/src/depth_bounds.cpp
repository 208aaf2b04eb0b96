// Bounds of depths in a solid. docs/algorithms/convex-decomposition.md, "From inside".
#include "depth_bounds.h"

#include <algorithm>
#include <array>

#include "cell.h"

namespace kaboum::bcd {
namespace {

/// Distances beyond the nearest triangle of points that may be outside, as shares of the diagonal;
/// proposals only, their winding number decides.
constexpr std::array<double, 3> kBeyond{1e-7, 1e-9, 1e-5};
/// Rounding, as a share of the largest coordinate and the diagonal.
constexpr double kSlack = 1e-12;

/// Every point as a triangle.
Mesh points_of(const Boundary& boundary) {
  Mesh out;
  out.vertices = boundary.outside;
  for (std::uint32_t i = 0; i < out.vertices.size(); ++i) out.triangles.push_back({i, i, i});
  return out;
}

}  // namespace

DepthBounds::DepthBounds(const Mesh& mesh, const geom::WindingNumber& winding,
                         const Boundary& boundary)
    : winding_(winding), query_(boundary.mesh), outside_(points_of(boundary)) {
  const Box3 box = geom::bounding_box(mesh);
  diagonal_ = box.diagonal();
  slack_ =
      kSlack * (diagonal_ + std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
}

bool DepthBounds::inside(const Vec3& p) const {
  const auto w = winding_(p);
  return !w || *w >= 1;
}

Vec3 DepthBounds::nearest_point(const Vec3& p, std::uint32_t triangle) const {
  const auto& [a, b, c] = query_.corners(triangle);
  return geom::nearest_point(p, a, b, c);
}

double DepthBounds::upper(const Vec3& p, std::uint32_t triangle) const {
  const auto& [a, b, c] = query_.corners(triangle);
  const Vec3 y = geom::nearest_point(p, a, b, c);
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 ray = (y - p).normalized();
  for (const double share : kBeyond) {
    const double step = share * diagonal_;
    for (const Vec3& direction : {ray, normal, Vec3(-normal)}) {
      if (!direction.allFinite()) continue;
      const Vec3 z = y + step * direction;
      const auto w = winding_(z);
      if (w && *w <= 0) return (z - p).norm() * kLengthUp + slack_;
    }
  }
  return outside_.nearest(p).upper;
}

}  // namespace kaboum::bcd
