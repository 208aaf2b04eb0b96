// Shapes as cells: meshes by triangle, spheres and cylinders by patches whose bulge is bounded.
// docs/algorithms/swept-volumes.md.
#include "swept_cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rounding.h"

namespace kaboum::verify {

using geom::Vec3;

namespace {

struct Corner {
  Vec3 point;
  bool on_surface;
};

/// Triangles of the surface.
using Patches = std::vector<std::array<Corner, 3>>;

Patches box(const Vec3& size) {
  Patches out;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const auto corner = [&](double u, double v) {
        Vec3 p;
        p[axis] = side * size[axis];
        p[(axis + 1) % 3] = u * size[(axis + 1) % 3];
        p[(axis + 2) % 3] = v * size[(axis + 2) % 3];
        return Corner{p, false};
      };
      out.push_back({corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5)});
      out.push_back({corner(-0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)});
    }
  }
  return out;
}

Patches cylinder(double radius, double length) {
  constexpr int kSides = 8;
  Patches out;
  const auto rim = [&](int i, double z) {
    const double angle = 2 * std::numbers::pi * (i % kSides) / kSides;
    return Corner{{radius * std::cos(angle), radius * std::sin(angle), z * length}, true};
  };
  for (int i = 0; i < kSides; ++i) {
    const Corner a = rim(i, -0.5), b = rim(i + 1, -0.5), c = rim(i + 1, 0.5), d = rim(i, 0.5);
    out.push_back({a, b, c});
    out.push_back({a, c, d});
    out.push_back({Corner{{0, 0, -0.5 * length}, false}, a, b});
    out.push_back({Corner{{0, 0, 0.5 * length}, false}, c, d});
  }
  return out;
}

Patches sphere(double radius) {
  Patches out;
  for (const double x : {-radius, radius})
    for (const double y : {-radius, radius})
      for (const double z : {-radius, radius})
        out.push_back({Corner{{x, 0, 0}, true}, Corner{{0, y, 0}, true}, Corner{{0, 0, z}, true}});
  return out;
}

}  // namespace

std::vector<SweptCell> SweptCell::cells_of(const MovingShape& shape) {
  std::vector<SweptCell> out;
  if (shape.kind == MovingShape::Kind::Mesh) {
    for (const geom::Triangle& t : shape.mesh.triangles) {
      SweptCell cell;
      for (int k = 0; k < 3; ++k) cell.points_[k] = shape.mesh.vertices[t[k]];
      out.push_back(cell);
    }
    return out;
  }
  using Kind = MovingShape::Kind;
  const Patches patches = shape.kind == Kind::Box        ? box(shape.size)
                          : shape.kind == Kind::Cylinder ? cylinder(shape.size.x(), shape.size.y())
                                                         : sphere(shape.size.x());
  for (const auto& patch : patches) {
    SweptCell cell;
    cell.count_ = 4;
    cell.points_[0] = Vec3::Zero();
    cell.round_ = shape.kind == Kind::Sphere;
    cell.curved_ = shape.kind != Kind::Box;
    cell.shape_radius_ = shape.size.x();
    for (int k = 0; k < 3; ++k) {
      cell.points_[k + 1] = patch[k].point;
      cell.on_surface_[k + 1] = patch[k].on_surface;
    }
    cell.measure();
    out.push_back(cell);
  }
  return out;
}

double SweptCell::size() const {
  double most = 0;
  for (int i = 0; i < count_; ++i)
    for (int k = 0; k < i; ++k) most = std::max(most, (points_[i] - points_[k]).squaredNorm());
  return std::sqrt(most) * kUp;
}

double SweptCell::radius() const {
  double most = 0;
  for (int i = 0; i < count_; ++i) most = std::max(most, points_[i].squaredNorm());
  return std::sqrt(most) * kUp;
}

double SweptCell::arc(int i, int k) const {
  if (!on_surface_[i] || !on_surface_[k]) return 0;
  const Vec3 edge = points_[i] - points_[k];
  return round_ ? edge.norm() : edge.head<2>().norm();
}

void SweptCell::measure() {
  bulge_ = 0;
  if (!curved_) return;
  double longest = 0;
  for (int i = 0; i < count_; ++i)
    for (int k = 0; k < i; ++k) longest = std::max(longest, arc(i, k));
  // What the points themselves err by when they are put on the surface is below.
  bulge_ = (longest * longest / (3 * shape_radius_) + 0x1p-48 * radius()) * kUp;
}

std::pair<SweptCell, SweptCell> SweptCell::halves(bool along_curve) const {
  int a = 0, b = 1;
  double longest = -1;
  for (int i = 0; i < count_; ++i) {
    for (int k = 0; k < i; ++k) {
      const double length = along_curve ? arc(i, k) : (points_[i] - points_[k]).norm();
      if (length <= longest) continue;
      longest = length;
      a = k;
      b = i;
    }
  }
  Vec3 middle = 0.5 * (points_[a] + points_[b]);
  if (along_curve) {
    const double outwards = shape_radius_ / (round_ ? middle.norm() : middle.head<2>().norm());
    if (round_) {
      middle *= outwards;
    } else {
      middle.head<2>() *= outwards;
    }
  }
  std::pair<SweptCell, SweptCell> out{*this, *this};
  out.first.points_[b] = middle;
  out.second.points_[a] = middle;
  for (SweptCell* cell : {&out.first, &out.second}) {
    cell->curved_ = curved_ && along_curve;
    if (cell->curved_) cell->measure();
  }
  return out;
}

}  // namespace kaboum::verify
