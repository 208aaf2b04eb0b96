#include "cover_points.h"

#include <kaboum/base/parallel.h>
#include <kaboum/base/random.h>

#include <algorithm>
#include <cmath>

namespace kaboum::bcd {
namespace {

using geom::Vec3;

constexpr std::size_t kMostVertices = 3'000;  ///< of the mesh, that are points to be held
/// Points of the inside, of which every so manieth is to be held at first.
constexpr std::size_t kInside = 20'000, kInsideShown = 29;

void sample_inside(const geom::Box3& box, const geom::WindingNumber& winding, CoverPoints& out) {
  const double volume = (box.max - box.min).prod();
  if (!(volume > 0)) return;
  std::vector<Vec3>& inside = out.inside;
  const double step = std::cbrt(volume / static_cast<double>(kInside));
  for (double x = box.min.x() + 0.5 * step; x < box.max.x(); x += step)
    for (double y = box.min.y() + 0.5 * step; y < box.max.y(); y += step)
      for (double z = box.min.z() + 0.5 * step; z < box.max.z(); z += step)
        inside.emplace_back(x, y, z);
  std::vector<char> is_inside(inside.size());
  kaboum::parallel_for(std::size_t{0}, inside.size(), [&](std::size_t i) {
    const std::optional<int> found = winding(inside[i]);
    is_inside[i] = found && *found >= 1;
  });
  std::size_t count = 0;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (is_inside[i] != 0) inside[count++] = inside[i];
  inside.resize(count);
  for (std::size_t i = 0; i < inside.size(); i += kInsideShown) out.first.push_back(inside[i]);
}

}  // namespace

CoverPoints sample_cover_points(const geom::Mesh& mesh, const geom::WindingNumber& winding,
                                std::optional<double> epsilon, std::size_t least,
                                std::size_t most) {
  CoverPoints out;
  Random random{1};
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double area = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    area += 0.5 *
            (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]).norm();
    sums.push_back(area);
  }
  std::size_t count = least;
  if (epsilon) {
    const double squares = area / (*epsilon * *epsilon);
    count = std::clamp(static_cast<std::size_t>(std::min(4 * squares, 1e9)), count, most);
  }
  const double step = area / static_cast<double>(count);
  double next = 0.5 * step;
  for (std::size_t t = 0; t < sums.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Vec3 normal = (b - a).cross(c - a);
    for (; next < sums[t]; next += step) {
      double u = random.between(0, 1), v = random.between(0, 1);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      out.surface.push_back({a + u * (b - a) + v * (c - a), -normal.normalized()});
    }
  }
  for (const SurfacePoint& p : out.surface) out.first.push_back(p.at);
  const std::size_t stride = mesh.vertices.size() / kMostVertices + 1;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += stride)
    out.first.push_back(mesh.vertices[v]);
  sample_inside(geom::bounding_box(mesh), winding, out);
  return out;
}

}  // namespace kaboum::bcd
