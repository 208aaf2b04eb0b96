// Boundary of a union of convex polytopes, by exact clipping.
#include <CGAL/Exact_rational.h>
#include <kaboum/geom/error.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/measure/surface.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace kaboum::measure {
namespace {

using geom::Box3;
using geom::Mesh;
using geom::Sign;
using geom::Vec3;
using Number = CGAL::Exact_rational;
using Point = std::array<Number, 3>;
using Polygon = std::vector<Point>;  // convex, planar, in order

Point exact(const Vec3& p) { return {Number(p.x()), Number(p.y()), Number(p.z())}; }

/// A facet's plane: corners as stored, and the normal in exact numbers, outwards.
struct Plane {
  std::array<Vec3, 3> corner;
  Point point, normal;
};

Plane plane_of(const std::array<Vec3, 3>& t) {
  const Point a = exact(t[0]), b = exact(t[1]), c = exact(t[2]);
  std::array<Number, 3> u, v;
  for (int k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  return {t, a, {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]}};
}

Number height(const Plane& plane, const Point& p) {
  Number sum = 0;
  for (int k = 0; k < 3; ++k) sum += plane.normal[k] * (p[k] - plane.point[k]);
  return sum;
}

/// Cuts a convex polygon; parts without area are dropped.
void split(const Polygon& polygon, const Plane& plane, Polygon& below, Polygon& above) {
  below.clear();
  above.clear();
  std::vector<Number> h;
  h.reserve(polygon.size());
  bool any_below = false, any_above = false;
  for (const Point& p : polygon) {
    h.push_back(height(plane, p));
    any_below = any_below || h.back() < 0;
    any_above = any_above || h.back() > 0;
  }
  if (!any_above) {
    below = polygon;
    return;
  }
  if (!any_below) {
    above = polygon;
    return;
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    if (h[i] <= 0) below.push_back(polygon[i]);
    if (h[i] >= 0) above.push_back(polygon[i]);
    if ((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0)) {
      const Number s = h[i] / (h[i] - h[j]);
      Point x;
      for (int k = 0; k < 3; ++k) x[k] = polygon[i][k] + s * (polygon[j][k] - polygon[i][k]);
      below.push_back(x);
      above.push_back(x);
    }
  }
}

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
  const Point n = plane_of(t).normal;
  Number sum = 0;
  for (int k = 0; k < 3; ++k) sum += n[k] * plane.normal[k];
  return sum > 0;
}

class Clipper {
 public:
  explicit Clipper(const geom::ConvexSet& set) {
    for (const auto& body : set.bodies) bodies_.push_back(make_body(body.hull));
  }

  UnionBoundary run() const {
    std::vector<std::vector<Polygon>> parts;
    std::vector<std::pair<std::size_t, std::size_t>> facets;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      for (std::size_t t = 0; t < bodies_[i].triangles.size(); ++t) facets.emplace_back(i, t);
    parts.resize(facets.size());
    tbb::parallel_for(std::size_t{0}, facets.size(), [&](std::size_t f) {
      parts[f] = uncovered(facets[f].first, facets[f].second);
    });
    UnionBoundary out;
    double largest = 0;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      for (const Polygon& polygon : parts[f]) {
        const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
        for (const Point& p : polygon) {
          out.mesh.vertices.emplace_back(CGAL::to_double(p[0]), CGAL::to_double(p[1]),
                                         CGAL::to_double(p[2]));
          largest = std::max(largest, out.mesh.vertices.back().cwiseAbs().maxCoeff());
        }
        for (std::uint32_t k = 2; k < polygon.size(); ++k)
          out.mesh.triangles.push_back({first, first + k - 1, first + k});
      }
    }
    // to_double errs by at most one ulp, 2^-52 relatively, per coordinate.
    out.error = largest * 4e-16;
    return out;
  }

 private:
  /// The parts of a facet that no other body covers from outside.
  std::vector<Polygon> uncovered(std::size_t body, std::size_t triangle) const {
    const auto& t = bodies_[body].triangles[triangle];
    Box3 box;
    for (const Vec3& p : t) box.extend(p);
    std::vector<Polygon> parts{{exact(t[0]), exact(t[1]), exact(t[2])}};
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
        split(inside, *plane, below, above);
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

UnionBoundary union_boundary(const geom::ConvexSet& set) {
  for (const geom::ConvexBody& body : set.bodies)
    if (!geom::is_convex(body.hull))
      throw Error(ErrorCode::InvalidInput, "body '" + body.name +
                                               "' is not convex (or has no volume); measure the "
                                               "file as a mesh instead");
  return Clipper(set).run();
}

}  // namespace kaboum::measure
