// Shapes by their sizes, as bodies and as meshes.

#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/world/primitive.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

namespace kaboum::world {
namespace {

using collide::BoundingSet;
using collide::Direction;
using geom::Vec3;
using Kind = Primitive::Kind;

constexpr int kSides = 64;       // of the prisms for a cylinder
constexpr int kFineSides = 256;  // of its mesh
constexpr int kFineSphere = 5;   // level of the meshes of balls
/// Far above all errors of rounding a point of a circle, far below any size.
constexpr double kRounding = 1e-12;

geom::Mesh hull_of(const std::vector<Vec3>& points) {
  auto hull = geom::convex_hull(points);
  ensure(hull.has_value(), "a primitive is not flat");
  return std::move(*hull);
}

/// A box, or the plate below a plane.
geom::Mesh box_of(const Primitive& p) {
  const Vec3 half = 0.5 * p.size;
  const double top = p.kind == Kind::Plane ? 0 : half.z(),
               bottom = p.kind == Kind::Plane ? -p.size.z() : -half.z();
  std::vector<Vec3> corners;
  for (const double x : {-half.x(), half.x()})
    for (const double y : {-half.y(), half.y()})
      for (const double z : {bottom, top}) corners.emplace_back(x, y, z);
  return hull_of(corners);
}

geom::Mesh prism(double radius, double length, int sides) {
  std::vector<Vec3> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    corners.emplace_back(x, y, -0.5 * length);
    corners.emplace_back(x, y, 0.5 * length);
  }
  return hull_of(corners);
}

/// Radius of the corners of a polygon round the unit circle: its edges are 1 + kRounding / 2 away
/// at least.
double radius_round(int sides) { return (1 + kRounding) / std::cos(std::numbers::pi / sides); }

/// Balls and capsules are bodies themselves.
geom::ConvexBody rounded(const Primitive& p) {
  geom::Mesh core;
  if (p.kind == Kind::Sphere)
    core.vertices = {Vec3::Zero()};
  else
    core.vertices = {{0, 0, -0.5 * p.length}, {0, 0, 0.5 * p.length}};
  return {name_of(p.kind), std::move(core), p.radius};
}

}  // namespace

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::Box:
      return "box";
    case Kind::Sphere:
      return "sphere";
    case Kind::Cylinder:
      return "cylinder";
    case Kind::Capsule:
      return "capsule";
    case Kind::Plane:
      break;
  }
  return "plane";
}

BoundingSet outer_set(const Primitive& p) {
  if (p.kind == Kind::Box || p.kind == Kind::Plane)
    return {{{name_of(p.kind), box_of(p), 0}}, Direction::Outer, 0};
  if (p.kind != Kind::Cylinder) return {{rounded(p)}, Direction::Outer, 0};
  const double outer = radius_round(kSides);
  return {{{"cylinder", prism(outer * p.radius, p.length, kSides), 0}},
          Direction::Outer,
          (outer - 1 + kRounding) * p.radius};
}

BoundingSet inner_set(const Primitive& p) {
  if (p.kind == Kind::Box || p.kind == Kind::Plane)
    return {{{name_of(p.kind), box_of(p), 0}}, Direction::Inner, 0};
  if (p.kind != Kind::Cylinder) return {{rounded(p)}, Direction::Inner, 0};
  // What the sides leave out is no deeper than the arrow of their arcs.
  return {{{"cylinder", prism((1 - kRounding) * p.radius, p.length, kSides), 0}},
          Direction::Inner,
          (1 - std::cos(std::numbers::pi / kSides) + 2 * kRounding) * p.radius};
}

geom::Mesh mesh_of(const Primitive& p) {
  if (p.kind == Kind::Box || p.kind == Kind::Plane) return box_of(p);
  if (p.kind == Kind::Cylinder) return prism((1 - kRounding) * p.radius, p.length, kFineSides);
  return geom::inscribed_polytope(rounded(p), geom::sphere_points(kFineSphere));
}

std::string to_json(const Primitive& p) {
  nlohmann::ordered_json sizes;
  if (p.kind == Kind::Box || p.kind == Kind::Plane) {
    sizes["size"] = {p.size.x(), p.size.y(), p.size.z()};
  } else {
    sizes["radius"] = p.radius;
    if (p.kind != Kind::Sphere) sizes["length"] = p.length;
  }
  return nlohmann::ordered_json{{name_of(p.kind), sizes}}.dump();
}

}  // namespace kaboum::world
