// Bodies that are wide enough in every direction. docs/algorithms/convex-decomposition.md, "Least
// thickness".

#include "thicken.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/width.h>

#include "outward.h"
#include "simplify.h"

namespace kaboum::bcd {
namespace {

/// A body round all points, rounded, and round the given one, which they contain but for rounding.
Mesh round(std::vector<Vec3> points, const Mesh& body, std::size_t most, const SolidField& solid) {
  for (Vec3& p : points) p = geom::to_float32(p);
  const auto hull = geom::convex_hull(points);
  ensure(hull.has_value(), "a body that was thickened is flat");
  std::vector<Vec3> required = hull->vertices;
  required.insert(required.end(), body.vertices.begin(), body.vertices.end());
  return enclose(simplify(hull->vertices, most, 0, solid).vertices, required, most);
}

/// The corners of cubes round all vertices: wide enough in every direction.
std::vector<Vec3> cubes_round(const Mesh& body, double half) {
  std::vector<Vec3> out;
  for (const Vec3& p : body.vertices)
    for (const Vec3& corner : Cell::of({-Vec3::Constant(half), Vec3::Constant(half)}).corners)
      out.emplace_back(p + corner);
  return out;
}

}  // namespace

Mesh thicken(Mesh body, double thickness, std::size_t most, const SolidField& solid) {
  // Each sweep settles one direction: a plate needs one, a rod two, a point three.
  constexpr int kSweeps = 8;
  for (int sweep = 0; sweep <= kSweeps; ++sweep) {
    const geom::Width width = geom::least_width(body, thickness);
    if (width.lower >= thickness) return body;
    double magnitude = thickness;
    for (const Vec3& p : body.vertices) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
    // Beyond what rounding to float32 takes away.
    const double step = 2 * geom::float32_spacing(magnitude);
    const Vec3 way = (0.5 * (thickness - width.lower) + step) * width.direction;
    std::vector<Vec3> swept;
    for (const Vec3& p : body.vertices)
      for (const Vec3& s : {way, Vec3(-way)}) swept.emplace_back(p + s);
    body = round(sweep < kSweeps ? swept : cubes_round(body, 0.5 * thickness + step), body, most,
                 solid);
  }
  ensure(geom::least_width(body, thickness).lower >= thickness, "a body stayed too thin");
  return body;
}

}  // namespace kaboum::bcd
