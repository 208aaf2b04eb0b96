// Self-intersections by another's code.
#include "independent_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <vector>

namespace kaboum::wrap {

bool meets_itself_by_cgal(const geom::Mesh& mesh) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  namespace processing = CGAL::Polygon_mesh_processing;
  std::vector<Kernel::Point_3> points;
  for (const geom::Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const auto& [a, b, c] : mesh.triangles) faces.push_back({a, b, c});
  if (!processing::is_polygon_soup_a_polygon_mesh(faces)) return true;
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  processing::polygon_soup_to_polygon_mesh(points, faces, surface);
  return processing::does_self_intersect(surface);
}

}  // namespace kaboum::wrap
