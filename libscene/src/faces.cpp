// Flat faces of convex sets, and their outlines.

#include "faces.h"

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/closest_point.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::scene {
namespace {

/// Between normals of triangles of one face. [rad]
constexpr double kSameFace = 1e-6;
/// Share of a set's size: what is so far from a face is just outside of it.
constexpr double kJustOutside = 1e-6;

}  // namespace

Faces::Faces(const collide::BoundingSet& set)
    : set_(set), size_(set.box().diagonal()), first_of_(set.size() + 1, 0) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    first_of_[i] = all_.size();
    add(set.body(i), i);
  }
  first_of_[set.size()] = all_.size();
}

bool Faces::is_covered(const Face& face, const Vec3& point) const {
  const Vec3 outside = point + kJustOutside * size_ * face.normal;
  for (std::size_t body = 0; body < set_.size(); ++body)
    if (body != face.body && holds(body, outside)) return true;
  return false;
}

std::vector<Polygon2> Faces::covers(const Face& face, const Axes& axes) const {
  const double level = face.offset + kJustOutside * size_;
  std::vector<Polygon2> out;
  for (std::size_t body = 0; body < set_.size(); ++body) {
    if (body == face.body) continue;
    const geom::Mesh surface = geom::surface_of(set_.body(body));
    std::vector<Vec2> section;
    for (const geom::Triangle& t : surface.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = surface.vertices[t[k]], &b = surface.vertices[t[(k + 1) % 3]];
        const double at_a = face.normal.dot(a) - level, at_b = face.normal.dot(b) - level;
        if (at_a <= 0 && at_b > 0) section.push_back(axes(a + at_a / (at_a - at_b) * (b - a)));
      }
    if (!section.empty()) out.push_back(convex_hull(std::move(section)));
  }
  return out;
}

bool Faces::holds(std::size_t body, const Vec3& point) const {
  const geom::Mesh& core = set_.body(body).core;
  const double radius = set_.body(body).radius;
  const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(first_of_[body]);
  const auto end = all_.begin() + static_cast<std::ptrdiff_t>(first_of_[body + 1]);
  const auto is_below = [&](double by) {
    return std::all_of(begin, end,
                       [&](const Face& f) { return f.normal.dot(point) < f.offset - by; });
  };
  if (radius == 0) return is_below(0);
  const auto is_near = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (geom::closest_point(point, a, b, c) - point).norm() < radius;
  };
  if (core.triangles.empty())  // a point or a segment
    return is_near(core.vertices.front(), core.vertices.back(), core.vertices.back());
  return is_below(radius) || std::ranges::any_of(core.triangles, [&](const geom::Triangle& t) {
           return is_near(core.vertices[t[0]], core.vertices[t[1]], core.vertices[t[2]]);
         });
}

void Faces::add(const geom::ConvexBody& of, std::size_t body) {
  const geom::Mesh& mesh = of.core;
  const std::size_t first = all_.size();
  for (const geom::Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 across = (b - a).cross(c - a);
    if (!(across.norm() > kNothing * kNothing * size_ * size_)) continue;
    const Vec3 normal = across.normalized();
    const auto same = std::find_if(
        all_.begin() + static_cast<std::ptrdiff_t>(first), all_.end(), [&](const Face& f) {
          return f.normal.cross(normal).norm() < kSameFace && f.normal.dot(normal) > 0;
        });
    Face& face = same == all_.end() ? all_.emplace_back() : *same;
    if (face.corners.empty()) face = {body, normal, normal.dot(a) + of.radius, {}};
    const Vec3 out = of.radius * face.normal;
    face.corners.insert(face.corners.end(), {a + out, b + out, c + out});
  }
}

Polygon2 flattened(const Face& face, const Axes& axes) {
  std::vector<Vec2> points;
  for (const Vec3& corner : face.corners) points.push_back(axes(corner));
  return convex_hull(std::move(points));
}

}  // namespace kaboum::scene
