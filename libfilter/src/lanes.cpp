// The vector code, compiled for each instruction set.

#include "lanes.h"

#include <kaboum/base/processor.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#ifdef KABOUM_AVX2
#include <immintrin.h>
#endif

namespace kaboum::filter::detail {
namespace {

using Answer = BatchChecker::Answer;

/// A model by pointers.
struct View {
  std::size_t variables, steps, shapes, clusters, cluster_pairs, outer_count, inner_count,
      body_count, shape_pairs, obstacle_pairs;
  const double *low, *high, *more;
  const float* base;
  const Step* step;
  const FrameBall *outer, *inner;
  const ShapeModel* shape;
  const BodyModel* body;
  const Cluster* cluster;
  const ClusterPair* cluster_pair;
  const Corner* corner;
  const Witness* witness;
  const Obstacle* obstacle;
  const Plane* plane;
  const CloudPoint* cloud_point;
  const CloudNode* cloud_node;
  const ObstacleGroup* group;
  const ShapePair* shape_pair;
  const ObstaclePair* obstacle_pair;
  float* memory;         // of one pack
  std::uint32_t* near;   // of each pair of clusters: the lanes in which they may meet
  unsigned char* ready;  // of each shape: which of its balls are placed
  float bend, blur_of_turns, blur_of_slides;  // as Model has them
  float slack;                                // that free ones are apart by, besides margins
  Look look;
  bool obstacles_first;
  std::uint32_t* pairs;  // that rows are open for, as OpenPairs has them; or null
  Suspect* suspects;     // of each row; or null
};

namespace baseline {
#define KABOUM_LANES 4
#include "lanes.inl"
#undef KABOUM_LANES
}  // namespace baseline

#ifdef KABOUM_AVX2
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#define KABOUM_LANES 8
#include "lanes.inl"
#undef KABOUM_LANES
}  // namespace avx2
#ifdef __clang__
#pragma clang attribute pop
#pragma clang attribute push(__attribute__((target("avx2,avx512f,avx512dq"))), apply_to = function)
#else
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx2,avx512f,avx512dq")
#endif
namespace avx512 {
#define KABOUM_LANES 16
#include "lanes.inl"
#undef KABOUM_LANES
}  // namespace avx512
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

LaneMemory::LaneMemory(const Model& model)
    : floats_(std::make_unique_for_overwrite<float[]>(
          (21 * (model.steps.size() + 1) +
           3 * (model.shapes.size() + model.clusters.size() + model.outer.size() +
                model.inner.size() + model.corners.size() + model.bodies.size()) +
           1) *
          kBlock)),
      near_(model.cluster_pairs.size()),
      ready_(model.shapes.size()) {}

float* LaneMemory::floats() {
  constexpr std::uintptr_t kAlignment = 4 * kBlock;
  const auto at = std::bit_cast<std::uintptr_t>(floats_.get());
  return floats_.get() + (kAlignment - at % kAlignment) % kAlignment / sizeof(float);
}

namespace {

View view_of(const Model& model, LaneMemory& memory, float slack = 0, Look look = Look::All,
             OpenPairs* pairs = nullptr, Suspect* suspects = nullptr) {
  return {model.variables,
          model.steps.size(),
          model.shapes.size(),
          model.clusters.size(),
          model.cluster_pairs.size(),
          model.outer.size(),
          model.inner.size(),
          model.bodies.size(),
          model.shape_pairs.size(),
          model.obstacle_pairs.size(),
          model.low.data(),
          model.high.data(),
          model.more.data(),
          model.base,
          model.steps.data(),
          model.outer.data(),
          model.inner.data(),
          model.shapes.data(),
          model.bodies.data(),
          model.clusters.data(),
          model.cluster_pairs.data(),
          model.corners.data(),
          model.witnesses.data(),
          model.obstacles.data(),
          model.planes.data(),
          model.cloud_points.data(),
          model.cloud_nodes.data(),
          model.groups.data(),
          model.shape_pairs.data(),
          model.obstacle_pairs.data(),
          memory.floats(),
          memory.near(),
          memory.ready(),
          model.bend,
          model.blur_of_turns,
          model.blur_of_slides,
          slack,
          look,
          model.obstacles_first,
          pairs == nullptr ? nullptr : pairs->data(),
          suspects};
}

}  // namespace

void filter_blocks(const Model& model, [[maybe_unused]] Instructions set, const double* rows,
                   const double* ways, std::size_t count, LaneMemory& memory,
                   BatchChecker::Answer* answers, float slack, Look look, OpenPairs* pairs,
                   Suspect* suspects) {
  const View view = view_of(model, memory, slack, look, pairs, suspects);
#ifdef KABOUM_AVX2
  if (set == Instructions::Avx512) return avx512::filter_blocks(view, rows, ways, count, answers);
  if (set == Instructions::Avx2) return avx2::filter_blocks(view, rows, ways, count, answers);
#endif
  baseline::filter_blocks(view, rows, ways, count, answers);
}

std::vector<double> in_blocks(const double* rows, std::size_t count, std::size_t variables) {
  std::vector<double> out(blocks_size(count, variables));
  for (std::size_t i = 0; i < (count + kBlock - 1) / kBlock * kBlock; ++i)
    for (std::size_t k = 0; k < variables; ++k)
      out[place_of(i, k, variables)] = rows[std::min(i, count - 1) * variables + k];
  return out;
}

void filter_rows(const Model& model, Instructions set, const double* rows, const double* ways,
                 std::size_t count, LaneMemory& memory, BatchChecker::Answer* answers,
                 float slack) {
  const std::vector<double> blocks = in_blocks(rows, count, model.variables),
                            of_ways = ways == nullptr ? std::vector<double>()
                                                      : in_blocks(ways, count, model.variables);
  filter_blocks(model, set, blocks.data(), ways == nullptr ? nullptr : of_ways.data(), count,
                memory, answers, slack);
}

void place_outer_balls(const Model& model, [[maybe_unused]] Instructions set, const double* rows,
                       std::size_t count, LaneMemory& memory, float* centers) {
  const View view = view_of(model, memory);
  const std::vector<double> blocks = in_blocks(rows, count, model.variables);
#ifdef KABOUM_AVX2
  if (set == Instructions::Avx512)
    return avx512::place_outer_balls(view, blocks.data(), count, centers);
  if (set == Instructions::Avx2)
    return avx2::place_outer_balls(view, blocks.data(), count, centers);
#endif
  baseline::place_outer_balls(view, blocks.data(), count, centers);
}

void sines_of([[maybe_unused]] Instructions set, const double* angles, std::size_t count,
              float* sines, float* cosines) {
#ifdef KABOUM_AVX2
  if (set == Instructions::Avx512) return avx512::sines_of(angles, count, sines, cosines);
  if (set == Instructions::Avx2) return avx2::sines_of(angles, count, sines, cosines);
#endif
  baseline::sines_of(angles, count, sines, cosines);
}

}  // namespace kaboum::filter::detail
