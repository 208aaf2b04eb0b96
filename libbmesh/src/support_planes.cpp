// Planes of a star of triangles that the original must stay beyond.

#include "support_planes.h"

#include <kaboum/geom/clip.h>

#include <cmath>
#include <limits>

#include "closest_triangle.h"
#include "fold.h"

namespace kaboum::bmesh {

/// Points nearer than this to a facet's outer edge, as a share of the facet's height, make no plane
/// through it: its slope would be all rounding.
constexpr double kAcross = 1e-3;

void SupportPlanes::assign(std::span<const NewTriangle> triangles) {
  facets_.clear();
  if (triangles.empty()) return;
  apex_ = triangles.front().corner[0];
  for (const NewTriangle& t : triangles) {
    const Vec3 &p = t.corner[1], &q = t.corner[2];
    const Vec3 n = (p - apex_).cross(q - apex_);
    const double length = n.norm();
    const Vec3 normal = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
    facets_.push_back({p, q, normal, normal.cross(q - p), -std::numeric_limits<double>::infinity(),
                       Vec3::Zero()});
  }
}

void SupportPlanes::keep(std::size_t i, const Vec3& point) {
  Facet& f = facets_[i];
  const double x = f.across.dot(point - f.p);
  if (!(x > kAcross * f.across.dot(apex_ - f.p))) return;
  const double slope = sign_ * f.normal.dot(point - f.p) / x;
  if (!(slope > f.slope)) return;
  f.slope = slope;
  f.through = point;
}

void SupportPlanes::keep(std::size_t i, const std::array<Vec3, 4>& tetrahedron,
                         const std::array<Vec3, 3>& triangle) {
  geom::ConvexPolygon part(triangle[0], triangle[1], triangle[2]);
  for (std::size_t k = 0; k < 4; ++k) {
    // The face across from corner k, with its normal pointing inwards.
    const Vec3& a = tetrahedron[(k + 1) % 4];
    Vec3 n = (tetrahedron[(k + 2) % 4] - a).cross(tetrahedron[(k + 3) % 4] - a);
    if (n.dot(tetrahedron[k] - a) < 0) n = -n;
    geom::ConvexPolygon below, above;
    if (geom::cut(part, a, n, below, above)) part = above;
  }
  for (int j = 0; j < part.size; ++j) {
    std::size_t nearest = i;
    if (i == kNearest) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < facets_.size(); ++k) {
        const double d = squared_distance(part.corner[j], {apex_, facets_[k].p, facets_[k].q});
        if (d >= least) continue;
        least = d;
        nearest = k;
      }
      if (nearest == kNearest) continue;
    }
    keep(nearest, part.corner[j]);
  }
}

void SupportPlanes::half_spaces(const Vec3& spread, std::vector<HalfSpace>& out) const {
  out.clear();
  for (const Facet& f : facets_) {
    if (!std::isfinite(f.slope)) continue;
    Vec3 normal = sign_ * (f.q - f.p).cross(f.through - f.p);
    const double length = normal.norm();
    if (!(length > 0)) continue;
    normal /= length;
    const double margin = kHalfSpacing * normal.cwiseAbs().dot(spread);
    out.push_back({normal, margin + normal.dot(f.p - apex_)});
  }
}

}  // namespace kaboum::bmesh
