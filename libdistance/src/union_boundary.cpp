// Boundary of a union of convex polytopes, by exact clipping.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/distance/boundary.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <array>

#include "exact_polygon.h"

namespace kaboum::distance {
namespace {

using exact::Polygon;
using geom::Box3;
using geom::Mesh;
using geom::Sign;
using geom::Vec3;

/// A facet's plane, exactly, and the corners as stored.
struct Plane : exact::Plane {
  std::array<Vec3, 3> corner;
};

Plane plane_of(const std::array<Vec3, 3>& t) { return {exact::plane_of(t), t}; }

/// A body's facets, one plane for each group of coplanar triangles, and its box.
struct Body {
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<Plane> planes;
  Box3 box;
};

bool coplanar(const Plane& plane, const std::array<Vec3, 3>& t) {
  return std::all_of(t.begin(), t.end(), [&](const Vec3& p) {
    return geom::orient3d(plane.corner[0], plane.corner[1], plane.corner[2], p) == Sign::Zero;
  });
}

Body make_body(const Mesh& hull) {
  Body body;
  for (const auto& [i, j, k] : hull.triangles) {
    const std::array<Vec3, 3> t{hull.vertices[i], hull.vertices[j], hull.vertices[k]};
    const auto normal = exact::plane_of(t).normal;
    if (exact::dot(normal, normal) == 0) continue;  // a segment has no plane and bounds nothing
    body.triangles.push_back(t);
    for (const Vec3& p : t) body.box.extend(p);
    if (std::none_of(body.planes.begin(), body.planes.end(),
                     [&](const Plane& plane) { return coplanar(plane, t); }))
      body.planes.push_back(plane_of(t));
  }
  return body;
}

bool overlap(const Box3& a, const Box3& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

bool same_direction(const std::array<Vec3, 3>& t, const Plane& plane) {
  return exact::dot(exact::plane_of(t).normal, plane.normal) > 0;
}

Polygon whole(const std::array<Vec3, 3>& t) {
  return {exact::point(t[0]), exact::point(t[1]), exact::point(t[2])};
}

class Clipper {
 public:
  explicit Clipper(const geom::ConvexSet& set) {
    for (const auto& body : set.bodies) bodies_.push_back(make_body(body.core));
  }

  Boundary run() const {
    std::vector<std::vector<Polygon>> parts;
    std::vector<std::pair<std::size_t, std::size_t>> facets;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      for (std::size_t t = 0; t < bodies_[i].triangles.size(); ++t) facets.emplace_back(i, t);
    parts.resize(facets.size());
    parallel_for(std::size_t{0}, facets.size(),
                 [&](std::size_t f) { parts[f] = uncovered(facets[f].first, facets[f].second); });
    Boundary out;
    double largest = 0;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      for (const Polygon& polygon : parts[f]) {
        const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
        for (const exact::Point& p : polygon) {
          out.mesh.vertices.push_back(exact::rounded(p));
          largest = std::max(largest, out.mesh.vertices.back().cwiseAbs().maxCoeff());
        }
        for (std::uint32_t k = 2; k < polygon.size(); ++k) {
          out.mesh.triangles.push_back({first, first + k - 1, first + k});
          const auto& facet = bodies_[facets[f].first].triangles[facets[f].second];
          out.facet.push_back(facet);
          out.whole.push_back(polygon == whole(facet) ? 1 : 0);
        }
      }
    }
    out.error = largest * exact::kRounding;
    return out;
  }

 private:
  /// The parts of a facet that no other body covers from outside.
  std::vector<Polygon> uncovered(std::size_t body, std::size_t triangle) const {
    const auto& t = bodies_[body].triangles[triangle];
    Box3 box;
    for (const Vec3& p : t) box.extend(p);
    std::vector<Polygon> parts{whole(t)};
    for (std::size_t j = 0; j < bodies_.size() && !parts.empty(); ++j)
      if (j != body && overlap(box, bodies_[j].box)) subtract(body, t, j, parts);
    return parts;
  }

  void subtract(std::size_t body, const std::array<Vec3, 3>& t, std::size_t other,
                std::vector<Polygon>& parts) const {
    // Planes that cut; a point just outside the facet is in the other body where it is below all
    // of them.
    std::vector<const Plane*> planes;
    for (const Plane& plane : bodies_[other].planes) {
      const auto& [a, b, c] = plane.corner;
      bool below = true, above = true, on = true;
      for (const Vec3& p : t) {
        const Sign s = geom::orient3d(a, b, c, p);
        below = below && s != Sign::Positive;
        above = above && s != Sign::Negative;
        on = on && s == Sign::Zero;
      }
      if (on) {
        // Facets that lie on each other: facing each other both are inside; looking the same way
        // one of them is enough.
        if (same_direction(t, plane) && body < other) return;
        continue;
      }
      if (above) return;
      if (!below) planes.push_back(&plane);
    }
    std::vector<Polygon> left;
    for (Polygon& part : parts) {
      Polygon inside = std::move(part), below, above;
      std::vector<Polygon> outside;
      for (const Plane* plane : planes) {
        exact::split(inside, *plane, below, above);
        if (!above.empty()) outside.push_back(above);
        inside = std::move(below);
        if (inside.empty()) break;
      }
      left.insert(left.end(), outside.begin(), outside.end());
    }
    parts = std::move(left);
  }

  std::vector<Body> bodies_;
};

}  // namespace

void require_convex(const geom::ConvexSet& set) {
  for (const geom::ConvexBody& body : set.bodies)
    if (!geom::is_convex(body))
      throw Error(ErrorCode::InvalidInput, "body '" + body.name +
                                               "' is not convex (or has no volume); measure it "
                                               "as a mesh, in one file");
}

Boundary union_boundary(const geom::ConvexSet& set) {
  require_convex(set);
  return Clipper(set).run();
}

}  // namespace kaboum::distance
