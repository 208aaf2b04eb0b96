#pragma once

#include <kaboum/base/processor.h>
#include <kaboum/geom/transform.h>

#include "meeting.h"

/// Products of poses in vectors of four doubles. What is computed does not depend on how many the
/// processor takes at once.
namespace kaboum::collide::detail {

/// What a matrix L is, beside a rotation.
struct RotationDefect {
  double square = 0;         ///< sum of the squares of the entries of LᵀL − I
  bool is_rotation = false;  ///< all of these are below what is asked, and the determinant above 0
};

void rotation_defect(const geom::Transform& pose, double most, RotationDefect& out,
                     bool wide = has_avx2());

/// Where a frame is in another one: p ↦ turn · p + way. The fourth number of each is of no use.
struct Relation {
  double turn[3][4];  ///< columns
  double way[4];
};

/// From the second frame into the first: Lᵀ(M p + s − t) for poses L, t and M, s.
void relate(const geom::Transform& first, const geom::Transform& second, Relation& out,
            bool wide = has_avx2());

/// A box that holds the image of the one about `center`, and `far` more: far · (1 + 2^-26) of the
/// image's half, and `error`.
struct MovedBox {
  double center[4];
  FloatBox box;
};
void move_box(const Relation& relation, const geom::Vec3& center, const geom::Vec3& half,
              double far, double error, MovedBox& out, bool wide = has_avx2());

/// The relation as the axes (columns) and the centre of a box see it, in floats: columns, and the
/// way from the centre to `point`, which is in the first frame; `size` is the sum of its numbers.
struct FloatRelation {
  float turn[3][4];
  float way[4];
  double size;
  double apart;  ///< lower bound, but for rounding, of how far that box is, along one of its axes,
                 ///< from a box about `point` along the axes of the second frame
};
/// Two boxes, by half their edges.
struct Halves {
  const double *own, *other;
};
void see_from(const Relation& relation, const Eigen::Matrix3d& axes, const geom::Vec3& center,
              const double* point, const Halves& half, FloatRelation& out, bool wide = has_avx2());

}  // namespace kaboum::collide::detail
