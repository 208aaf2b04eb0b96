// The vector code, compiled for each instruction set.

#include "lanes.h"

#include <kaboum/base/processor.h>

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
  std::size_t variables, steps, shapes, outer_count, inner_count, body_count, shape_pairs,
      obstacle_pairs;
  const double *low, *high;
  const float* base;
  const Step* step;
  const FrameBall *outer, *inner;
  const ShapeModel* shape;
  const BodyModel* body;
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
  unsigned char* ready;  // of each shape: which of its balls are placed
  float slack;           // that free ones are apart by, besides margins
  Look look;
  bool obstacles_first;
  std::uint32_t* pairs;  // that rows are open for, as OpenPairs has them; or null
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

constexpr std::size_t kMostLanes = 16;

}  // namespace

LaneMemory::LaneMemory(const Model& model)
    : floats_(std::make_unique_for_overwrite<float[]>(
          (14 * (model.steps.size() + 1) +
           3 * (model.shapes.size() + model.outer.size() + model.inner.size() +
                model.corners.size() + model.bodies.size()) +
           1) *
          kMostLanes)),
      ready_(model.shapes.size()) {}

float* LaneMemory::floats() {
  constexpr std::uintptr_t kAlignment = 4 * kMostLanes;
  const auto at = std::bit_cast<std::uintptr_t>(floats_.get());
  return floats_.get() + (kAlignment - at % kAlignment) % kAlignment / sizeof(float);
}

namespace {

View view_of(const Model& model, LaneMemory& memory, float slack = 0, Look look = Look::All,
             OpenPairs* pairs = nullptr) {
  return {model.variables,
          model.steps.size(),
          model.shapes.size(),
          model.outer.size(),
          model.inner.size(),
          model.bodies.size(),
          model.shape_pairs.size(),
          model.obstacle_pairs.size(),
          model.low.data(),
          model.high.data(),
          model.base,
          model.steps.data(),
          model.outer.data(),
          model.inner.data(),
          model.shapes.data(),
          model.bodies.data(),
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
          memory.ready(),
          slack,
          look,
          model.obstacles_first,
          pairs == nullptr ? nullptr : pairs->data()};
}

}  // namespace

void filter_rows(const Model& model, [[maybe_unused]] Instructions set, const double* rows,
                 const double* widths, std::size_t count, LaneMemory& memory,
                 BatchChecker::Answer* answers, float slack, Look look, OpenPairs* pairs) {
  const View view = view_of(model, memory, slack, look, pairs);
#ifdef KABOUM_AVX2
  if (set == Instructions::Avx512) return avx512::filter_rows(view, rows, widths, count, answers);
  if (set == Instructions::Avx2) return avx2::filter_rows(view, rows, widths, count, answers);
#endif
  baseline::filter_rows(view, rows, widths, count, answers);
}

void place_outer_balls(const Model& model, [[maybe_unused]] Instructions set, const double* rows,
                       std::size_t count, LaneMemory& memory, float* centers) {
  const View view = view_of(model, memory);
#ifdef KABOUM_AVX2
  if (set == Instructions::Avx512) return avx512::place_outer_balls(view, rows, count, centers);
  if (set == Instructions::Avx2) return avx2::place_outer_balls(view, rows, count, centers);
#endif
  baseline::place_outer_balls(view, rows, count, centers);
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
