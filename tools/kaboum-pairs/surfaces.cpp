// The meshes of a robot's links.

#include "surfaces.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/robot/exact_shapes.h>

#include <cmath>

namespace kaboum::tools {
namespace {

using geom::Mesh;
using geom::Vec3;
using robot::Geometry;

void append(Mesh& all, const Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const geom::Triangle& t : mesh.triangles)
    all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Of a cylinder or sphere, a polytope that lies in it: the corners of the one that encloses it,
/// moved onto its surface, and a little less.
Mesh inscribed(const Geometry& shape) {
  constexpr double kDown = 1 - 1e-9;
  std::vector<Vec3> points;
  for (const Vec3& corner : robot::bounding_points(shape)) {
    const Vec3 p = shape.origin.linear.transpose() * (corner - shape.origin.translation);
    Vec3 q;
    if (shape.shape == Geometry::Shape::Sphere) {
      q = shape.size.x() * kDown * p.normalized();
    } else {
      const double radius = shape.size.x() * kDown, half = 0.5 * shape.size.y() * kDown;
      const double across = std::hypot(p.x(), p.y());
      q = {p.x() / across * radius, p.y() / across * radius, p.z() > 0 ? half : -half};
    }
    points.push_back(shape.origin * q);
  }
  return geom::convex_hull(points).value_or(Mesh{});
}

/// Adds a shape. @return whether both meshes got the same
bool add(const Geometry& shape, const Mesh& exact, const std::string& link, pairs::LinkSurface& out,
         Mesh& inner, std::vector<std::string>& notes) {
  if (shape.shape == Geometry::Shape::Cylinder || shape.shape == Geometry::Shape::Sphere) {
    append(out.outer, exact);
    if (!is_flat(shape)) append(inner, inscribed(shape));
    return false;
  }
  append(inner, exact);
  if (shape.shape == Geometry::Shape::Mesh) {
    try {
      const geom::Prepared prepared = geom::prepare(exact, {.holes = geom::Holes::Fill});
      if (prepared.solid.filled_triangles() > 0) {
        append(out.outer, prepared.solid.mesh());
        return false;
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::InvalidInput) throw;
      notes.push_back("'" + link + "': a mesh has no solid (" + error.what() +
                      "); only its triangles are looked at");
    }
  }
  append(out.outer, exact);
  return !is_flat(shape);
}

}  // namespace

std::vector<pairs::LinkSurface> surfaces_of(const robot::RobotFile& file,
                                            const robot::ShapeChoice& choice,
                                            std::vector<std::string>& notes) {
  robot::require_links(file, choice.links);
  std::vector<pairs::LinkSurface> out;
  for (std::uint32_t l = 0; l < file.robot.links.size(); ++l) {
    const robot::Link& link = file.robot.links[l];
    if (!choice.has(link)) continue;
    pairs::LinkSurface surface;
    surface.link = l;
    Mesh inner;
    bool same = true;
    for (const Geometry& shape : choice.shapes_of(link)) {
      const Mesh exact = robot::exact_shapes({shape}, file, choice.packages);
      if (exact.empty()) continue;
      geom::require_valid(exact);
      const bool alike = add(shape, exact, link.name, surface, inner, notes);
      same = same && alike;
    }
    if (surface.outer.empty()) continue;
    if (!same) surface.inner = std::move(inner);
    out.push_back(std::move(surface));
  }
  return out;
}

}  // namespace kaboum::tools
