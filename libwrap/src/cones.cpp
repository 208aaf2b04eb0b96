// Tetrahedra that are free of triangles: separating planes, certain in spite of rounding.
#include "cones.h"

#include <cmath>
#include <limits>

namespace kaboum::wrap {
namespace {

inline bool overlap(const geom::Box3& a, const geom::Box3& b) {
  bool apart = false;  // without branches
  for (int k = 0; k < 3; ++k) apart |= (a.min[k] > b.max[k]) | (b.min[k] > a.max[k]);
  return !apart;
}

double largest(const Vec3& x) { return x.cwiseAbs().maxCoeff(); }

}  // namespace

void Cones::set(std::span<const Tetrahedron> tetrahedra, double clearance) {
  clearance_ = clearance;
  origin_ = tetrahedra.front()[3];
  cones_.resize(tetrahedra.size());
  all_ = {};
  for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
    Cone& cone = cones_[i];
    cone.box = {};
    for (const Vec3& p : tetrahedra[i]) cone.box.extend(p);
    if (clearance > 0) {
      for (int k = 0; k < 3; ++k) {  // twice, and outwards: no matter how it is rounded
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        cone.box.min[k] = std::nextafter(cone.box.min[k] - 2 * clearance, -kInfinity);
        cone.box.max[k] = std::nextafter(cone.box.max[k] + 2 * clearance, kInfinity);
      }
    }
    all_.extend(cone.box);
    for (std::size_t k = 0; k < 3; ++k) cone.corner[k] = tetrahedra[i][k] - origin_;
  }
  most_ = std::max(largest(all_.min - origin_), largest(all_.max - origin_));

  // Most of the input lies behind the triangles opposite the common corner.
  Vec3 sum = Vec3::Zero();
  for (Cone& cone : cones_) {
    const auto& [a, b, c] = cone.corner;
    const std::array<Vec3, 4> normals{(b - a).cross(c - a), a.cross(b), b.cross(c), c.cross(a)};
    sum += normals[0];
    for (std::size_t k = 0; k < 4; ++k) {
      cone.faces[k] = {normals[k], range_along(normals[k], cone.corner), {normals[k], clearance}};
      cone.faces[k].range.extend(0);  // the last corner
    }
  }
  common_ = {sum, {}, {sum, clearance}};
  common_.range.extend(0);
  for (const Cone& cone : cones_)
    for (const Vec3& p : cone.corner) common_.range.extend(sum.dot(p));
}

bool Cones::may_meet(const geom::Box3& box) const {
  if (!overlap(box, all_)) return false;
  // Only what is in their box can be near them: one margin does for every box.
  Range range{0, 0};
  for (int k = 0; k < 3; ++k) {
    const double a = common_.n[k] * (std::max(box.min[k], all_.min[k]) - origin_[k]),
                 b = common_.n[k] * (std::min(box.max[k], all_.max[k]) - origin_[k]);
    range.low += std::min(a, b);
    range.high += std::max(a, b);
  }
  return !wrap::apart(range, common_.range, common_.margin.at(most_));
}

bool Cones::clear_of(const Corners& triangle, const Vec3& normal) const {
  geom::Box3 box;
  for (const Vec3& p : triangle) box.extend(p);
  if (!overlap(box, all_)) return true;
  Relative relative{{}, most_};
  for (std::size_t k = 0; k < 3; ++k) {
    relative.corner[k] = triangle[k] - origin_;
    relative.most = std::max(relative.most, largest(relative.corner[k]));
  }
  if (wrap::apart(range_along(common_.n, relative.corner), common_.range,
                  common_.margin.at(relative.most)))
    return true;
  for (const Cone& cone : cones_)
    if (overlap(box, cone.box) && !apart(cone, relative, normal)) return false;
  return true;
}

bool Cones::apart(const Cone& cone, const Relative& triangle, const Vec3& normal) const {
  for (const Axis& axis : cone.faces)
    if (wrap::apart(range_along(axis.n, triangle.corner), axis.range,
                    axis.margin.at(triangle.most)))
      return true;
  const auto along = [&](const Vec3& n) {
    Range range = range_along(n, cone.corner);
    range.extend(0);
    return wrap::apart(range_along(n, triangle.corner), range,
                       Margin(n, clearance_).at(triangle.most));
  };
  if (along(normal)) return true;
  const auto& [a, b, c] = triangle.corner;
  const auto& [p, q, r] = cone.corner;
  for (const Vec3& e : {Vec3(b - a), Vec3(c - b), Vec3(a - c)})
    for (const Vec3& f : {p, q, r, Vec3(q - p), Vec3(r - q), Vec3(p - r)})
      if (along(e.cross(f))) return true;
  return false;
}

}  // namespace kaboum::wrap
