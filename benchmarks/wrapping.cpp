// Wrapping beside CGAL's Alpha_wrap_3 (GPL: here only, never installed): triangles, user CPU time
// and the farthest distance of the wrap from the input, at equal offset and equal gap to seal. A
// ball of radius alpha has the diameter that our wraps seal. Both results are judged by libverify.
// Each file has a process of its own, so that one does not leave its memory to the next.
//
// usage: wrapping-benchmark OFFSET SEAL FILE ...    OFFSET and SEAL as shares of the diagonal

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/self_intersection.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/wrap/wrap.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "common.h"

namespace {

using namespace kaboum;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

geom::Mesh alpha_wrap(const geom::Mesh& mesh, double alpha, double offset) {
  std::vector<Kernel::Point_3> points;
  for (const geom::Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const auto& [a, b, c] : mesh.triangles) faces.push_back({a, b, c});
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  CGAL::alpha_wrap_3(points, faces, alpha, offset, wrap);
  geom::Mesh result;
  for (const auto v : wrap.vertices())
    result.vertices.emplace_back(wrap.point(v).x(), wrap.point(v).y(), wrap.point(v).z());
  for (const auto f : wrap.faces()) {
    geom::Triangle t{};
    int i = 0;
    for (const auto v : wrap.vertices_around_face(wrap.halfedge(f)))
      t[i++] = static_cast<std::uint32_t>(v);
    result.triangles.push_back(t);
  }
  return result;
}

struct Row {
  std::size_t triangles, crossing;
  bool manifold;
  double seconds, distance, volume;
  const char* inside;
};

template <class Make>
Row measured(const geom::Mesh& input, double diagonal, Make&& make) {
  const double before = benchmark::user_seconds();
  const geom::Mesh mesh = make();
  const double seconds = benchmark::user_seconds() - before;
  const geom::DistanceQuery query(input);
  const double far = geom::directed_distance(mesh, query, {.relative_gap = 0.01}).max_upper;
  verify::InclusionOptions options;
  options.surface_only = true;
  const auto answer = verify::verify_inclusion(input, mesh, options).surface.answer;
  const geom::SelfIntersections meets = geom::self_intersections(mesh);
  const geom::TopologyReport topology = geom::analyse(mesh);
  return {mesh.triangles.size(),
          meets.triangles + meets.flat,
          topology.closed() && topology.manifold(),
          seconds,
          far / diagonal,
          geom::signed_volume(mesh),
          verify::name_of(answer)};
}

std::string clean(const Row& row) {
  return std::to_string(row.crossing) + (row.manifold ? "" : ", not manifold");
}

void compare(const char* file, double offset_share, double seal_share) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const geom::Mesh input = io::read_mesh(file).mesh;
  const double diagonal = geom::bounding_box(input).diagonal();
  const double offset = offset_share * diagonal, seal = seal_share * diagonal;
  const Row ours = measured(input, diagonal, [&] {
    wrap::WrapOptions options;
    options.offset = offset;
    options.seal = seal;
    return wrap::wrap(input, options).mesh;
  });
  const Row theirs = measured(input, diagonal, [&] { return alpha_wrap(input, seal / 2, offset); });
  const auto name = std::filesystem::path(file).filename();
  std::printf(
      "| %s | %zu | %zu | %zu | %s | %s | %.3f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %s, %s "
      "|\n",
      name.c_str(), input.triangles.size(), ours.triangles, theirs.triangles, clean(ours).c_str(),
      clean(theirs).c_str(), ours.volume / theirs.volume, ours.seconds, theirs.seconds,
      ours.seconds / theirs.seconds, 100 * ours.distance, 100 * theirs.distance,
      ours.distance / theirs.distance, ours.inside, theirs.inside);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: wrapping-benchmark OFFSET SEAL FILE ...\n");
    return 2;
  }
  std::printf(
      "| mesh | triangles | ours | CGAL's | crossing | CGAL's | volume ratio | s | CGAL's s | CPU "
      "ratio | farthest, %% | CGAL's, %% | ratio | inside |\n");
  std::printf("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n");
  std::fflush(stdout);
  for (int i = 3; i < argc; ++i) {
    if (fork() == 0) {
      compare(argv[i], std::atof(argv[1]), std::atof(argv[2]));
      return 0;
    }
    int status = 0;
    if (wait(&status) < 0 || status != 0) return 1;
  }
  return 0;
}
