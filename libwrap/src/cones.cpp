// Tetrahedra that are free of triangles: separating planes, certain in spite of rounding.
#include "cones.h"

#include <cmath>
#include <limits>

namespace kaboum::wrap {
namespace {

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
  chosen_.clear();
  for (const Cone& cone : cones_) chosen_.push_back(&cone);
}

bool Cones::parts(const Axis& axis, const geom::Box3& box, const geom::Box3& near) const {
  Range range{0, 0};
  for (int k = 0; k < 3; ++k) {
    const double a = axis.n[k] * (std::max(box.min[k], near.min[k]) - origin_[k]),
                 b = axis.n[k] * (std::min(box.max[k], near.max[k]) - origin_[k]);
    range.low += std::min(a, b);
    range.high += std::max(a, b);
  }
  // What is in the cones' box is no farther than they are: one margin does for every box.
  return wrap::apart(range, axis.range, axis.margin.at(most_));
}

bool Cones::may_meet(const geom::Box3& box) const {
  return overlap(box, all_) && !parts(common_, box, all_);
}

bool Cones::choose(const geom::Box3& box) {
  chosen_.clear();
  for (const Cone& cone : cones_)
    if (overlap(box, cone.box) && !parts(cone.faces[0], box, cone.box)) chosen_.push_back(&cone);
  return !chosen_.empty();
}

bool Cones::clear_of(const Corners& triangle) const {
  geom::Box3 box;
  for (const Vec3& p : triangle) box.extend(p);
  if (!overlap(box, all_)) return true;
  Relative relative{{}, most_};
  for (std::size_t k = 0; k < 3; ++k) {
    relative.corner[k] = triangle[k] - origin_;
    relative.most = std::max(relative.most, largest(relative.corner[k]));
  }
  for (const Cone* cone : chosen_)
    if (overlap(box, cone->box) && !apart(*cone, relative)) return false;
  return true;
}

bool Cones::apart(const Cone& cone, const Relative& triangle) const {
  for (const Axis& axis : cone.faces)
    if (wrap::apart(range_along(axis.n, triangle.corner), axis.range,
                    axis.margin.at(triangle.most)))
      return true;
  bool between = false;  // whether some plane is between them, at whatever distance
  const auto along = [&](const Vec3& n) {
    Range range = range_along(n, cone.corner);
    range.extend(0);
    const Range other = range_along(n, triangle.corner);
    between |= wrap::apart(other, range, 0);
    return wrap::apart(other, range, Margin(n, clearance_).at(triangle.most));
  };
  const auto& [a, b, c] = triangle.corner;
  if (along((b - a).cross(c - a))) return true;
  const auto& [p, q, r] = cone.corner;
  for (const Vec3& e : {Vec3(b - a), Vec3(c - b), Vec3(a - c)})
    for (const Vec3& f : {p, q, r, Vec3(q - p), Vec3(r - q), Vec3(p - r)})
      if (along(e.cross(f))) return true;
  if (!(clearance_ > 0)) return false;
  for (const Axis& axis : cone.faces)
    between |= wrap::apart(range_along(axis.n, triangle.corner), axis.range, 0);
  return between && apart_at_corners(cone, triangle, along);
}

/// Where a corner of one is what is nearest to the other, the widest gap is along the way from it
/// to a corner or an edge there.
template <class Along>
bool Cones::apart_at_corners(const Cone& cone, const Relative& triangle, Along&& along) {
  const Vec3 last = Vec3::Zero();
  const auto& [p, q, r] = cone.corner;
  const auto& [a, b, c] = triangle.corner;
  const auto from_edge = [](const Vec3& x, const Vec3& from, const Vec3& to) {
    const Vec3 e = to - from, d = x - from;
    return Vec3(d - d.dot(e) / e.squaredNorm() * e);
  };
  using Edge = std::pair<const Vec3*, const Vec3*>;
  for (const Vec3* x : {&a, &b, &c}) {
    for (const Vec3* y : {&p, &q, &r, &last})
      if (along(*x - *y)) return true;
    for (const auto& [y, z] :
         {Edge{&p, &last}, {&q, &last}, {&r, &last}, {&p, &q}, {&q, &r}, {&r, &p}})
      if (along(from_edge(*x, *y, *z))) return true;
  }
  for (const Vec3* x : {&p, &q, &r, &last})
    for (const auto& [y, z] : {Edge{&a, &b}, {&b, &c}, {&c, &a}})
      if (along(from_edge(*x, *y, *z))) return true;
  return false;
}

}  // namespace kaboum::wrap
