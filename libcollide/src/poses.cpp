// Products of poses, compiled for each instruction set.

#include "poses.h"

#include <cstdint>

namespace kaboum::collide::detail {
namespace {

#ifdef __GNUC__
// Vectors wider than the processor's are handed over within this source only.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
namespace baseline {
#include "poses.inl"
}  // namespace baseline

#ifdef KABOUM_AVX2
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#include "poses.inl"
}  // namespace avx2
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

/// The matrix, column by column, and the vector behind it.
const double* numbers(const geom::Transform& pose) {
  static_assert(sizeof(geom::Transform) == 12 * sizeof(double));
  return pose.linear.data();
}

}  // namespace

#ifdef KABOUM_AVX2
#define KABOUM_CALL(function, ...) \
  if (wide)                        \
    avx2::function(__VA_ARGS__);   \
  else                             \
    baseline::function(__VA_ARGS__)
#else
#define KABOUM_CALL(function, ...) baseline::function(__VA_ARGS__)
#endif

void rotation_defect(const geom::Transform& pose, double most, RotationDefect& out,
                     [[maybe_unused]] bool wide) {
  KABOUM_CALL(rotation_defect, numbers(pose), most, out);
}

void relate(const geom::Transform& first, const geom::Transform& second, Relation& out,
            [[maybe_unused]] bool wide) {
  KABOUM_CALL(relate, numbers(first), numbers(second), out);
}

void move_box(const Relation& relation, const geom::Vec3& center, const geom::Vec3& half,
              double far, double error, MovedBox& out, [[maybe_unused]] bool wide) {
  KABOUM_CALL(move_box, relation, center.data(), half.data(), far, error, out);
}

void see_from(const Relation& relation, const Eigen::Matrix3d& axes, const geom::Vec3& center,
              const double* point, const Halves& half, FloatRelation& out,
              [[maybe_unused]] bool wide) {
  KABOUM_CALL(see, relation, axes.data(), center.data(), point, half, out);
}

#undef KABOUM_CALL

}  // namespace kaboum::collide::detail
