#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/facets.h>
#include <kaboum/geom/float32.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "facet_hull.h"

/// Hulls of few facets round the hulls of meshes: how much larger their volume is. Columns: planes
/// left out one by one, which is what Progressive Convex Hull Simplification (2604.14468) does, our
/// make of it; then also turned; then also exchanged.
///
///   facet-hull-benchmark MESH...
namespace {

using namespace kaboum;
using geom::Vec3;

double processor() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double volume_of(const geom::Mesh& hull) {
  double sum = 0;
  const Vec3& at = hull.vertices.front();
  for (const auto& [a, b, c] : hull.triangles)
    sum += (hull.vertices[a] - at).dot((hull.vertices[b] - at).cross(hull.vertices[c] - at));
  return sum / 6;
}

struct Column {
  std::vector<double> extra;  ///< share of the hull's volume
  double seconds = 0;
  void print(const char* name) {
    std::ranges::sort(extra);
    double sum = 0;
    for (const double x : extra) sum += x;
    std::printf("%12s %9.2f %9.2f %9.2f %9.2f\n", name, 100 * sum / double(extra.size()),
                100 * extra[extra.size() / 2], 100 * extra.back(),
                1e3 * seconds / double(extra.size()));
  }
};

void measure(const std::vector<std::string>& files, std::size_t facets) {
  using bcd::PlaneSteps;
  std::map<std::string, Column> columns;
  std::size_t meshes = 0;
  for (const std::string& file : files) {
    const geom::Mesh mesh = io::read_mesh(file).mesh;
    std::vector<Vec3> points = mesh.vertices;
    for (Vec3& p : points) p = geom::to_float32(p);
    const auto hull = geom::convex_hull(points);
    // Those that have no more anyway tell nothing.
    if (!hull || geom::float32_facet_count(*hull) <= facets) continue;
    ++meshes;
    const double whole = volume_of(*hull);
    for (const auto& [name, steps] :
         {std::pair{"left out", PlaneSteps::Removal}, std::pair{"turned", PlaneSteps::Turning},
          std::pair{"exchanged", PlaneSteps::Exchange}}) {
      const double start = processor();
      const geom::Mesh few = bcd::facet_hull(hull->vertices, facets, 1000, steps);
      columns[name].seconds += processor() - start;
      columns[name].extra.push_back(volume_of(few) / whole - 1);
      if (geom::float32_facet_count(few) > facets)
        std::printf("too many facets: %s\n", file.c_str());
    }
  }
  if (meshes == 0) return;
  std::printf("%zu facets, %zu hulls of more: extra volume\n%12s %9s %9s %9s %9s\n", facets, meshes,
              "", "mean %", "median %", "most %", "ms");
  for (const char* name : {"left out", "turned", "exchanged"}) columns[name].print(name);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> files(argv + 1, argv + argc);
    for (const std::size_t facets : {6U, 8U, 12U, 18U, 32U, 64U}) measure(files, facets);
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
