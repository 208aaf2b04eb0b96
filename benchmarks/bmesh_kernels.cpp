// Kernels of decimation, one at a time: bmesh_kernels [Google Benchmark's options]
#include <benchmark/benchmark.h>
#include <kaboum/geom/predicates.h>

#include <cmath>
#include <random>

#include "bucket_queue.h"
#include "closest_triangle.h"
#include "placement.h"
#include "reference_solid.h"

namespace {

using namespace kaboum;         // NOLINT: a program
using namespace kaboum::bmesh;  // NOLINT

/// A bumpy height field over n × n quads.
geom::Mesh terrain(int n) {
  geom::Mesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      mesh.vertices.emplace_back(i, j, std::sin(0.7 * i) * std::cos(0.4 * j));
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

std::vector<Vec3> points(std::size_t n, double size) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, size);
  std::vector<Vec3> out(n);
  for (Vec3& p : out) p = Vec3(unit(random), unit(random), unit(random) / size);
  return out;
}

void placement(benchmark::State& state) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  Quadric q;
  std::vector<HalfSpace> planes;
  for (int i = 0; i < state.range(0); ++i) {
    const Vec3 n = Vec3(unit(random), unit(random), 3).normalized();
    planes.push_back({n, 0.1 * unit(random)});
    q += plane_quadric(Vec3(0, 0, 0.1 * unit(random)), n);
  }
  for (auto _ : state) benchmark::DoNotOptimize(minimise(q, q.half_gradient(Vec3::Zero()), planes));
}
BENCHMARK(placement)->Arg(6)->Arg(10)->Arg(40);

void orientation(benchmark::State& state) {
  const auto p = points(1024, 1);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        geom::orient3d(p[i & 1023], p[(i + 1) & 1023], p[(i + 2) & 1023], p[(i + 3) & 1023]));
    ++i;
  }
}
BENCHMARK(orientation);

void orientation_of_coplanar_points(benchmark::State& state) {
  const Vec3 a(0.1, 0.2, 0.3), b(1.1, 0.2, 0.3), c(0.1, 1.2, 0.3), d(0.7, 0.9, 0.3);
  for (auto _ : state) benchmark::DoNotOptimize(geom::orient3d(a, b, c, d));
}
BENCHMARK(orientation_of_coplanar_points);

void queue(benchmark::State& state) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  BucketQueue q;
  for (std::uint32_t i = 0; i < 100000; ++i) q.push(unit(random), {i, i, 0});
  double key = 0;
  for (auto _ : state) {
    BucketQueue::Entry e;
    q.pop(e);
    key = q.lowest_key() + unit(random);
    q.push(key, e);
  }
}
BENCHMARK(queue);

void nearest_triangle(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const geom::Mesh mesh = terrain(n);
  const ClosestTriangle proximity(mesh);
  const auto p = points(4096, n);
  std::size_t i = 0;
  for (auto _ : state) {
    std::uint32_t hint = 0;
    benchmark::DoNotOptimize(proximity.squared(p[++i & 4095], hint));
  }
}
BENCHMARK(nearest_triangle)->Arg(32)->Arg(256);

void triangle_against_tetrahedron(benchmark::State& state) {
  const auto p = points(4096, 1);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto at = [&](std::size_t k) { return p[(i + k) & 4095]; };
    benchmark::DoNotOptimize(meets_interior({at(0), at(1), at(2), at(3)}, {at(4), at(5), at(6)}));
    ++i;
  }
}
BENCHMARK(triangle_against_tetrahedron);

}  // namespace

BENCHMARK_MAIN();
