// Certified Hausdorff distances against CGAL's bounded-error function, both directions, one run:
//
//   hausdorff-benchmark MESH COARSE TOUCHING [--own-only]
//
// MESH and COARSE are measured against each other, then MESH subdivided twice against COARSE, then
// MESH against TOUCHING; the error allowed is 1e-4 of the diagonal. Times are user CPU, including
// the search structures. CGAL's part is GPL: this program is never installed.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#include <kaboum/geom/distance.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/measure/search.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>

namespace {

using namespace kaboum;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
constexpr double kError = 1e-4;  // of the diagonal

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

geom::Mesh subdivided(const geom::Mesh& mesh) {
  geom::Mesh out;
  out.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
  const auto between = [&](std::uint32_t a, std::uint32_t b) {
    const auto [it, fresh] =
        middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(out.vertices.size()));
    if (fresh) out.vertices.emplace_back(0.5 * mesh.vertices[a] + 0.5 * mesh.vertices[b]);
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t x = between(a, b), y = between(b, c), z = between(c, a);
    out.triangles.insert(out.triangles.end(), {{a, x, z}, {x, b, y}, {z, y, c}, {x, y, z}});
  }
  return out;
}

SurfaceMesh converted(const geom::Mesh& mesh) {
  SurfaceMesh out;
  for (const geom::Vec3& v : mesh.vertices) out.add_vertex({v.x(), v.y(), v.z()});
  using Index = SurfaceMesh::Vertex_index;
  for (const auto& [a, b, c] : mesh.triangles)
    if (out.add_face(Index(a), Index(b), Index(c)) == SurfaceMesh::null_face())
      std::fprintf(stderr, "warning: CGAL does not take a non-manifold triangle\n");
  return out;
}

struct Answer {
  double seconds = 0;
  double lower[2]{}, upper[2]{};
};

Answer ours(const geom::Mesh& a, const geom::Mesh& b, measure::Backend backend) {
  Answer answer;
  const double start = user_seconds();
  geom::DistanceOptions options;
  options.relative_gap = 0;
  options.absolute_gap = kError;
  const auto search_a = measure::make_search(a, backend),
             search_b = measure::make_search(b, backend);
  const double built = user_seconds();
  const auto there = geom::directed_distance(*search_a, *search_b, options);
  const double turned = user_seconds();
  const auto back = geom::directed_distance(*search_b, *search_a, options);
  answer.seconds = user_seconds() - start;
  std::printf("  %-9s build %.3f, there %.3f (%llu queries), back %.3f (%llu)\n",
              backend == measure::Backend::Own ? "own" : "Embree", built - start, turned - built,
              static_cast<unsigned long long>(there.queries), user_seconds() - turned,
              static_cast<unsigned long long>(back.queries));
  answer.lower[0] = there.max_lower;
  answer.upper[0] = there.max_upper;
  answer.lower[1] = back.max_lower;
  answer.upper[1] = back.max_upper;
  return answer;
}

Answer cgal(const geom::Mesh& a, const geom::Mesh& b, double error) {
  const SurfaceMesh x = converted(a), y = converted(b);
  namespace PMP = CGAL::Polygon_mesh_processing;
  Answer answer;
  const double start = user_seconds();
  const double there = PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(x, y, error);
  const double turned = user_seconds();
  const double back = PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(y, x, error);
  answer.seconds = user_seconds() - start;
  std::printf("  CGAL      there %.3f, back %.3f\n", turned - start, user_seconds() - turned);
  answer.lower[0] = there - error;
  answer.upper[0] = there + error;
  answer.lower[1] = back - error;
  answer.upper[1] = back + error;
  return answer;
}

void compare(const char* title, const geom::Mesh& a, const geom::Mesh& b, bool with_cgal) {
  geom::Box3 box = geom::bounding_box(a);
  box.extend(geom::bounding_box(b));
  std::printf("%s: %zu and %zu triangles\n", title, a.triangles.size(), b.triangles.size());
  const Answer own = ours(a, b, measure::Backend::Own);
  const Answer embree = ours(a, b, measure::Backend::Embree);
  for (int k = 0; k < 2; ++k)
    std::printf("  %s [%.6e, %.6e]\n", k == 0 ? "there" : "back ", embree.lower[k],
                embree.upper[k]);
  if (!with_cgal) return;
  const Answer reference = cgal(a, b, kError * box.diagonal());
  bool agree = true;
  for (const Answer* answer : {&own, &embree})
    for (int k = 0; k < 2; ++k)
      agree =
          agree && answer->lower[k] <= reference.upper[k] && answer->upper[k] >= reference.lower[k];
  std::printf("  CGAL / Embree %.1f, CGAL / own %.1f, intervals %s\n",
              reference.seconds / embree.seconds, reference.seconds / own.seconds,
              agree ? "meet" : "DO NOT MEET");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: hausdorff-benchmark MESH COARSE TOUCHING [--own-only]\n");
    return 2;
  }
  const bool with_cgal = argc < 5 || std::strcmp(argv[4], "--own-only") != 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const geom::Mesh mesh = io::read_mesh(argv[1]).mesh, coarse = io::read_mesh(argv[2]).mesh,
                   touching = io::read_mesh(argv[3]).mesh;
  compare("coarse", mesh, coarse, with_cgal);
  compare("subdivided", subdivided(subdivided(mesh)), coarse, with_cgal);
  compare("touching", mesh, touching, with_cgal);
}
