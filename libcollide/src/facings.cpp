// A body of one set as the other set sees it.

#include "facings.h"

#include <cmath>
#include <limits>

namespace kaboum::collide::detail {
namespace {

using geom::Vec3;

/// Larger than what matrices of sets may differ from rotations by.
constexpr double kDefect = 0x1p-26;
constexpr double kLargest = 1e8;  ///< of coordinates in floats [length]
/// Holds the rounding of a number to a float, twice over.
constexpr double kFloatUp = 1 + 0x1p-22;

void set(float* to, const Vec3& from) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

/// Not below x, which is not negative.
float above(double x) { return static_cast<float>(x * kFloatUp); }

}  // namespace

Facings::Facings(const PosedSet& faces, const PosedSet& lanes, double slack)
    : faces_(&faces), lanes_(&lanes) {
  const BoundingSet &f = faces.set(), &l = lanes.set();
  empty_ = f.size() == 0 || l.size() == 0;
  if (empty_) return;
  relate(faces.pose(), lanes.pose(), relation_);
  const Shapes &own = *f.shapes_, &shapes = *l.shapes_;
  reach_ = slack + faces.error() + lanes.error();
  const double* way = relation_.way;
  const double far = std::abs(way[0]) + std::abs(way[1]) + std::abs(way[2]);
  size_ = own.reach + shapes.reach + far;
  move_box(relation_, shapes.origin, shapes.half, reach_, kDefect * size_, whole_);
  in_floats_ = own.in_floats && shapes.in_floats && reach_ <= kLargest && far <= kLargest;
}

FloatBox Facings::moved(const PosedSet& set, std::size_t body, const Relation& relation) const {
  const BoundingSet& own = set.set();
  const auto& level = own.levels_[0];
  Vec3 center, half;
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = own.rows_[level.at(k) + body], high = own.rows_[level.at(3 + k) + body];
    center[static_cast<int>(k)] = 0.5 * low + 0.5 * high;
    half[static_cast<int>(k)] = 0.5 * high - 0.5 * low;
  }
  // Beyond floats nothing is known of it.
  constexpr float kMost = std::numeric_limits<float>::max();
  constexpr double kLargestInRows = 1e37;
  const double largest = std::max(center.cwiseAbs().maxCoeff(), half.maxCoeff());
  MovedBox out;
  move_box(relation, center, half, reach_, kDefect * size_, out);
  for (int k = 0; k < 3; ++k) {
    const bool is_known =
        largest <= kLargestInRows && out.box.low[k] <= kMost && out.box.high[k] >= -kMost;
    if (is_known) continue;
    out.box.low[k] = -std::numeric_limits<float>::infinity();
    out.box.high[k] = std::numeric_limits<float>::infinity();
  }
  return out.box;
}

FloatBox Facings::seen(std::size_t face) const {
  Relation back;
  relate(lanes_->pose(), faces_->pose(), back);
  return moved(*faces_, face, back);
}

bool Facings::face_lanes(std::size_t face, Facing& out) const {
  const Shape& shape = faces_->set().shapes_->shape[face];
  const double error = (2 * (faces_->defect_ + lanes_->defect_) + 0x1p-46) * size_;
  out.reach = static_cast<float>(faces_->radius_above(face) + reach_);
  out.is_round = shape.kind == Shape::Kind::Round;
  if (!out.is_round) {
    see_from(relation_, shape.axes, shape.center, whole_.center,
             {shape.half.data(), lanes_->set().shapes_->half.data()}, out.relation);
    const double far = (faces_->radius_above(face) + reach_) * (1 + kDefect) + shape.deviation;
    if (out.relation.apart > far + kDefect * size_) return false;
    set(out.half, shape.half);
    out.size = above(out.relation.size + shape.half[0] + shape.half[1] + shape.half[2]);
    out.outer = above(error + shape.deviation);
    out.inner = shape.kind == Shape::Kind::Box ? out.outer : std::numeric_limits<float>::infinity();
    return true;
  }
  const Vec3 half = 0.5 * (shape.ends[1] - shape.ends[0]);
  const Vec3& all = lanes_->set().shapes_->half;
  const double far = (faces_->radius_above(face) + reach_) * (1 + kDefect) + kDefect * size_;
  double size = 0, half_size = 0, first_size = 0, second_size = 0;
  double to[3];
  for (int i = 0; i < 3; ++i) to[i] = whole_.center[i] - shape.center[i];
  for (int i = 0; i < 3; ++i) {
    // Ends in the lanes' frame.
    double middle = 0, along = 0;
    for (int j = 0; j < 3; ++j) {
      middle -= relation_.turn[i][j] * to[j];
      along += relation_.turn[i][j] * half[j];
    }
    if (std::abs(middle) - std::abs(along) > all[i] + far) return false;
    out.first[i] = static_cast<float>(middle - along);
    out.second[i] = static_cast<float>(middle + along);
    first_size += std::abs(middle - along);
    second_size += std::abs(middle + along);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.relation.turn[j][i] = static_cast<float>(relation_.turn[j][i]);
    out.relation.way[i] = static_cast<float>(to[i]);
    size += std::abs(to[i]);
    half_size += std::abs(half[i]);
  }
  set(out.half, half);
  out.size = above(std::max(size + half_size, std::max(first_size, second_size)));
  out.outer = out.inner = above(error);
  return true;
}

}  // namespace kaboum::collide::detail
