// Certified Hausdorff distances against CGAL's bounded-error function, both directions, one run:
//
//   hausdorff-benchmark MESH COARSE TOUCHING [--own-only]
//   hausdorff-benchmark --pairs [--samples N] MESH...
//
// MESH and COARSE are measured against each other, then MESH subdivided twice against COARSE, then
// MESH against TOUCHING; the error allowed is 1e-4 of the diagonal. Times are user CPU, including
// the search structures.
//
// --pairs: every MESH against its outer and inner bounding meshes of 50, 20 and 5 % of the
// vertices, both directions. Two claims are checked of each: the upper bound is not below the
// distance of any of N points of the surface (10^7 unless told), and the interval meets that of
// CGAL's answer and its error. Exit code 1 if any fails. CGAL's part is GPL: this program is never
// installed.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/distance/minimum.h>
#include <kaboum/distance/sampling.h>
#include <kaboum/distance/search.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/mesh_io.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "common.h"

namespace {

using namespace kaboum;
using benchmark::subdivided;
using benchmark::user_seconds;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
constexpr double kError = 1e-4;  // of the diagonal

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

Answer ours(const geom::Mesh& a, const geom::Mesh& b, distance::Backend backend) {
  Answer answer;
  const double start = user_seconds();
  geom::DistanceOptions options;
  options.relative_gap = 0;
  options.absolute_gap = kError;
  const auto search_a = distance::make_search(a, backend),
             search_b = distance::make_search(b, backend);
  const double built = user_seconds();
  const auto there = geom::directed_distance(*search_a, *search_b, options);
  const double turned = user_seconds();
  const auto back = geom::directed_distance(*search_b, *search_a, options);
  answer.seconds = user_seconds() - start;
  std::printf("  %-9s build %.3f, there %.3f (%llu queries), back %.3f (%llu)\n",
              backend == distance::Backend::Own ? "own" : "Embree", built - start, turned - built,
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
  const Answer own = ours(a, b, distance::Backend::Own);
  const Answer embree = ours(a, b, distance::Backend::Embree);
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

/// Largest distance of the sampled points, and how far rounding may have moved them off A.
std::pair<double, double> sampled_maximum(const geom::Mesh& a, const geom::TriangleSearch& b,
                                          std::uint64_t samples) {
  double largest = 0;  // one thread
  const distance::Sampled s =
      distance::sample_distances(a, b, samples, 1, [&](const geom::Vec3&, double d) {
        largest = std::max(largest, d);
        return d;
      });
  return {largest, s.rounding};
}

/// Both claims for one pair. @return whether they hold.
bool check(const char* title, const geom::Mesh& a, const geom::Mesh& b, std::uint64_t samples) {
  geom::Box3 box = geom::bounding_box(a);
  box.extend(geom::bounding_box(b));
  const double error = kError * box.diagonal();
  const Answer embree = ours(a, b, distance::Backend::Embree);
  const Answer reference = cgal(a, b, error);
  const auto search_a = distance::make_search(a, distance::Backend::Embree),
             search_b = distance::make_search(b, distance::Backend::Embree);
  const auto there = sampled_maximum(a, *search_b, samples),
             back = sampled_maximum(b, *search_a, samples);
  bool good = true;
  for (int k = 0; k < 2; ++k) {
    const auto& [largest, rounding] = k == 0 ? there : back;
    const bool covers = embree.upper[k] >= largest - rounding;
    const bool meets =
        embree.lower[k] <= reference.upper[k] && embree.upper[k] >= reference.lower[k];
    // How much of CGAL's interval's half width is left before the two come apart.
    const double overlap =
        std::min(embree.upper[k] - reference.lower[k], reference.upper[k] - embree.lower[k]) /
        error;
    good = good && covers && meets;
    std::printf("%-40s %-5s [%.6e, %.6e] samples %.6e CGAL %.6e overlap %.2f %s\n", title,
                k == 0 ? "there" : "back", embree.lower[k], embree.upper[k], largest,
                0.5 * (reference.lower[k] + reference.upper[k]), overlap,
                !covers ? "SAMPLE ABOVE"
                : meets ? "holds"
                        : "DO NOT MEET");
  }
  std::fflush(stdout);
  return good;
}

/// @return the number of pairs for which a claim fails.
int check_pairs(const std::vector<std::string>& files, std::uint64_t samples) {
  int pairs = 0, failures = 0;
  for (const std::string& file : files) {
    const geom::Prepared prepared = geom::prepare(io::read_mesh(file).mesh);
    std::size_t vertices = geom::analyse(prepared.solid.mesh()).vertices;
    for (const bmesh::Direction direction : {bmesh::Direction::Outer, bmesh::Direction::Inner})
      for (const int percent : {50, 20, 5}) {
        bmesh::DecimateOptions options;
        options.direction = direction;
        options.precision = bmesh::Precision::Double;
        options.vertices = std::max<std::size_t>(4, vertices * percent / 100);
        const geom::Mesh other = bmesh::decimate(prepared.solid, options).mesh;
        const std::string title = file.substr(file.rfind('/') + 1) +
                                  (direction == bmesh::Direction::Outer ? " outer " : " inner ") +
                                  std::to_string(percent) + "%";
        ++pairs;
        if (!check(title.c_str(), prepared.solid.mesh(), other, samples)) ++failures;
      }
  }
  std::printf("%d pairs, %d failures, %llu samples each way\n", pairs, failures,
              static_cast<unsigned long long>(samples));
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc >= 3 && std::strcmp(argv[1], "--pairs") == 0) {
    std::uint64_t samples = 10000000;
    std::vector<std::string> files;
    for (int i = 2; i < argc; ++i) {
      if (std::strcmp(argv[i], "--samples") == 0 && i + 1 < argc)
        samples = std::strtoull(argv[++i], nullptr, 10);
      else
        files.emplace_back(argv[i]);
    }
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    return check_pairs(files, samples) == 0 ? 0 : 1;
  }
  if (argc < 4) {
    std::fprintf(stderr,
                 "usage: hausdorff-benchmark MESH COARSE TOUCHING [--own-only]\n"
                 "       hausdorff-benchmark --pairs [--samples N] MESH...\n");
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
