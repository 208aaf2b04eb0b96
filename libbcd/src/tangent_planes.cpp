// Planes through an edge that touch a convex hull: the last of its points in the order of angles
// round the edge.

#include "tangent_planes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kaboum::bcd {
namespace {

using geom::Vec3;

/// A facet of less area than this share of its longest side times the hull's size is a sliver,
/// whose plane is left to a search.
constexpr double kSliver = 1e-6;
/// Points no farther beyond a plane than this share of the hull's size are on it.
constexpr double kOnPlane = 1e-12;
/// Points nearer to the edge's line than this share of the size have no certain plane with it.
constexpr double kOnLine = 1e-9;

}  // namespace

void TangentPlanes::add_facet(const geom::Triangle& triangle, const std::array<Vec3, 3>& corners,
                              const HalfSpace& plane) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).norm());
  const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  if (!(area > kSliver * longest * size_)) return;
  for (std::size_t k = 0; k < 3; ++k)
    known_.try_emplace(key(triangle[k], triangle[(k + 1) % 3]), plane);
}

const HalfSpace* TangentPlanes::through(std::uint32_t from, std::uint32_t to, const Vec3& u,
                                        const Vec3& w) {
  const auto [at, fresh] = known_.try_emplace(key(from, to));
  if (fresh) at->second = find(u, w);
  return at->second ? &*at->second : nullptr;
}

std::optional<HalfSpace> TangentPlanes::find(const Vec3& u, const Vec3& w) const {
  const Vec3 e = w - u;
  const double length = e.norm();
  if (!(length > 0)) return std::nullopt;
  const double eps = kOnPlane * size_;
  Vec3 n = Vec3::Zero();
  double below = -1;  // boxes that are, hold nothing of interest
  bool found = false;
  hull_.visit_above([&] { return std::pair<const Vec3&, double>(n, below); },
                    [&](const Vec3& p) {
                      const Vec3 r = p - u;
                      if (found && n.dot(r) <= eps) return true;
                      // Facet (p, u, w): normal (u − p) × (w − p) = r × … oriented with e and r.
                      const Vec3 m = e.cross(r);
                      const double size = m.norm();
                      if (size <= kOnLine * length * size_) return true;
                      n = m / size;
                      below = n.dot(u);
                      found = true;
                      return true;
                    });
  if (!found) return std::nullopt;
  return HalfSpace{n, n.dot(u)};
}

}  // namespace kaboum::bcd
