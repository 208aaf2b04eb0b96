// Time and memory of deciding enclosure, as CSV on standard output:
//
//   verify-benchmark [--quick]
//   verify-benchmark --files INNER OUTER
//
// Needs KABOUM_MESHES. Bounding meshes are made first; seconds are user CPU on one thread, of the
// decision alone. --quick leaves out what takes more than a few seconds. --files: two meshes, the
// first of which lies in the second, as they are, along a curve through space, and shuffled. Exit
// status 1 if an answer is not the expected one.
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/spatial_order.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/inclusion.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>
#include <stdexcept>

#include "common.h"
#include "support/shapes.h"
#include "verify/pairs.h"

namespace {

using namespace kaboum;
using benchmark::user_seconds;
using geom::Mesh;
using verify::Answer;

class Table {
 public:
  Table() {
    std::puts("case,inner_triangles,outer_triangles,solid,surface,contacts,samples,user_seconds");
  }
  void row(const char* title, const Mesh& inner, const Mesh& outer, Answer expected) {
    const double start = user_seconds();
    const verify::Inclusion result = verify::verify_inclusion(inner, outer);
    const double seconds = user_seconds() - start;
    std::printf("%s,%zu,%zu,%s,%s,%zu,%zu,%.3f\n", title, inner.triangles.size(),
                outer.triangles.size(), name_of(result.solid.answer),
                name_of(result.surface.answer), result.contacts, result.samples, seconds);
    std::fflush(stdout);
    good_ = good_ && result.solid.answer == expected;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  bool good_ = true;
};

Mesh read(const char* name) {
  const char* corpus = std::getenv("KABOUM_MESHES");
  if (corpus == nullptr) throw std::runtime_error("KABOUM_MESHES is not set");
  return geom::prepare(io::read_mesh(std::string(corpus) + "/" + name).mesh).solid.mesh();
}

Mesh outer_mesh(const Mesh& mesh, double ratio) {
  bmesh::DecimateOptions options;
  options.vertices = static_cast<std::size_t>(ratio * static_cast<double>(mesh.vertices.size()));
  return bmesh::decimate(geom::prepare(mesh).solid, options).mesh;
}

/// The same triangles and vertices, numbered as the two lists have them.
Mesh renumbered(const Mesh& mesh, const std::vector<std::uint32_t>& triangles,
                const std::vector<std::uint32_t>& vertices) {
  Mesh out;
  std::vector<std::uint32_t> number(vertices.size());
  for (const std::uint32_t v : vertices) {
    number[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(mesh.vertices[v]);
  }
  for (const std::uint32_t t : triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    out.triangles.push_back({number[a], number[b], number[c]});
  }
  return out;
}

Mesh in_space(const Mesh& mesh) {
  return renumbered(mesh, geom::spatial_order(mesh), geom::spatial_order(mesh.vertices, 0));
}

Mesh shuffled(const Mesh& mesh) {
  std::mt19937 random(1);
  std::vector<std::uint32_t> triangles(mesh.triangles.size()), vertices(mesh.vertices.size());
  for (std::vector<std::uint32_t>* list : {&triangles, &vertices}) {
    std::iota(list->begin(), list->end(), 0U);
    std::shuffle(list->begin(), list->end(), random);
  }
  return renumbered(mesh, triangles, vertices);
}

/// One pair in three orders.
void compare_orders(Table& table, const Mesh& inner, const Mesh& outer) {
  table.row("as they are", inner, outer, Answer::Verified);
  table.row("in space", in_space(inner), in_space(outer), Answer::Verified);
  table.row("shuffled", shuffled(inner), shuffled(outer), Answer::Verified);
}

}  // namespace

int main(int argc, char** argv) try {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  Table table;
  if (argc == 4 && std::strcmp(argv[1], "--files") == 0) {
    compare_orders(table, io::read_mesh(argv[2]).mesh, io::read_mesh(argv[3]).mesh);
    return table.good() ? 0 : 1;
  }
  const Mesh bunny = read("scan-stanford-bunny-34835-closed.ply");
  table.row("bunny in outer 50 %", bunny, outer_mesh(bunny, 0.5), Answer::Verified);
  table.row("bunny in outer 20 %", bunny, outer_mesh(bunny, 0.2), Answer::Verified);
  table.row("bunny in outer 5 %", bunny, outer_mesh(bunny, 0.05), Answer::Verified);
  if (quick) return table.good() ? 0 : 1;
  {
    const Mesh dragon = read("scan-stanford-dragon-437645.ply");
    table.row("dragon in outer 5 %", dragon, outer_mesh(dragon, 0.05), Answer::Verified);
  }
  const Mesh fine = test::subdivided(test::subdivided(bunny));
  {
    const Mesh coarse = outer_mesh(fine, 0.2);
    table.row("subdivided bunny in outer 20 %", fine, coarse, Answer::Verified);
    table.row("outer 20 % in subdivided bunny", coarse, fine, Answer::Refuted);
  }
  {
    const Mesh bent = benchmark::subdivided(benchmark::subdivided(bunny));
    compare_orders(table, bent, outer_mesh(bent, 0.2));
  }
  // Subdivision rounds midpoints where it must: the fine surface is the coarse one but for an ulp.
  table.row("cube of 995,328 in cube of 12", test::box({1, 1, 1}, 288), test::box({1, 1, 1}, 1),
            Answer::Verified);
  table.row("cube of 12 in cube of 995,328", test::box({1, 1, 1}, 1), test::box({1, 1, 1}, 288),
            Answer::Verified);
  table.row("subdivided bunny in bunny", fine, bunny, Answer::Verified);
  table.row("bunny in subdivided bunny", bunny, fine, Answer::Verified);
  return table.good() ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "verify-benchmark: %s\n", e.what());
  return 2;
}
