// Sets of bodies, and sets at their places.

#include <kaboum/base/error.h>
#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lengths.h"
#include "meeting.h"
#include "poses.h"
#include "shapes.h"

namespace kaboum::collide {
namespace {

using detail::kSumUp;
using detail::require_length;
using geom::Box3;
using geom::Vec3;

constexpr double kFarthest = 1e60;  ///< as Posed takes it

/// Whether it only swaps axes and turns them round.
bool swaps_axes(const Eigen::Matrix3d& l) {
  for (int i = 0; i < 9; ++i) {
    const double x = l.data()[i];
    if (!(x == 0 || x == 1 || x == -1)) return false;
  }
  return true;
}

/// Bounds |LᵀL − I|: 0 for matrices that only swap axes and turn them round. An entry of nine errs
/// by less than 5 · 2^-52.
double bound_of_defect(const Eigen::Matrix3d& l, double square) {
  if (square == 0 && swaps_axes(l)) return 0;
  return std::sqrt(square) + 0x1p-47;
}

/// Floats not above and not below a number.
float below(double x) {
  const auto out = static_cast<float>(x);
  return out > x ? std::nextafter(out, -std::numeric_limits<float>::infinity()) : out;
}
float above(double x) { return -below(-x); }

/// A ball round the points that is at most a hundredth larger than the smallest
/// one: M. Bădoiu, K. L. Clarkson, Smaller core-sets for balls, 2003.
BoundingSet::Ball ball_of(const std::vector<geom::ConvexBody>& bodies, const Box3& box) {
  BoundingSet::Ball out;
  out.radius = std::numeric_limits<double>::infinity();
  if (box.empty()) return {};
  Vec3 center = box.center();
  for (int step = 1; step <= 100; ++step) {
    double most = 0;
    Vec3 farthest = center;
    for (const geom::ConvexBody& body : bodies) {
      for (const Vec3& p : body.core.vertices) {
        const double reach = (p - center).norm() + body.radius;
        if (reach <= most) continue;
        most = reach;
        farthest = p;
      }
    }
    if (most < out.radius) out = {center, most};
    center += (farthest - center) / (step + 1);
  }
  out.radius *= kSumUp;
  return out;
}

Direction direction_of(const geom::ConvexSet& set) {
  if (set.provenance.direction == "outer") return Direction::Outer;
  if (set.provenance.direction == "inner") return Direction::Inner;
  throw Error(ErrorCode::InvalidInput,
              "the set does not state whether it is an outer or an inner one");
}

double epsilon_of(const geom::ConvexSet& set) {
  if (set.provenance.epsilon) return *set.provenance.epsilon;
  throw Error(ErrorCode::InvalidInput,
              "the set states no epsilon: how far it is from its solid is not certified");
}

std::vector<geom::ConvexBody> bodies_of(const geom::ConvexSet& set) {
  if (const auto i = geom::find_not_convex(set))
    throw Error(ErrorCode::InvalidInput,
                "body " + std::to_string(*i) + " ('" + set.bodies[*i].name + "') is not convex");
  return set.bodies;
}

}  // namespace

BoundingSet::BoundingSet(std::vector<geom::ConvexBody> bodies, Direction direction, double epsilon)
    : bodies_(std::move(bodies)),
      direction_(direction),
      epsilon_(require_length(epsilon, "an epsilon")) {
  for (const geom::ConvexBody& body : bodies_) {
    require_length(body.radius, "a radius");
    const Box3& box = polytopes_.emplace_back(body.core.vertices).box();
    const Vec3 reach = Vec3::Constant(body.radius * kSumUp) +
                       0x1p-50 * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs());
    box_.extend(Box3{box.min - reach, box.max + reach});
  }
  constexpr std::size_t kFew = 64;
  is_cloud_ = size() > kFew && std::ranges::all_of(bodies_, [&](const geom::ConvexBody& body) {
                return body.core.vertices.size() == 1 && body.radius == bodies_.front().radius;
              });
  ball_ = ball_of(bodies_, box_);
  shapes_ = std::make_shared<const detail::Shapes>(bodies_, box_);
  add_levels();
}

void BoundingSet::add_levels() {
  std::size_t count = size(), all = 6 * count;
  levels_.push_back({0, count});
  while (count > kBlock) {
    count = (count + kBlock - 1) / kBlock;
    levels_.push_back({all, count});
    all += 6 * count;
  }
  rows_.resize(all + detail::kBoxesAtOnce);
  for (std::size_t i = 0; i < size(); ++i) {
    const Box3& box = polytopes_[i].box();
    const Vec3 reach =
        Vec3::Constant(bodies_[i].radius * kSumUp) + 0x1p-50 * polytopes_[i].magnitude();
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      rows_[levels_[0].at(k) + i] = below(box.min[axis] - reach[axis]);
      rows_[levels_[0].at(3 + k) + i] = above(box.max[axis] + reach[axis]);
    }
  }
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const Level &lower = levels_[l - 1], &here = levels_[l];
    for (std::size_t row = 0; row < 6; ++row)
      for (std::size_t i = 0; i < here.count; ++i) {
        const float* first = rows_.data() + lower.at(row) + i * kBlock;
        const float* last = first + std::min(kBlock, lower.count - i * kBlock);
        rows_[here.at(row) + i] =
            row < 3 ? *std::min_element(first, last) : *std::max_element(first, last);
      }
  }
}

BoundingSet::BoundingSet(const geom::ConvexSet& set)
    : BoundingSet(bodies_of(set), direction_of(set), epsilon_of(set)) {}

PosedSet::PosedSet(const BoundingSet& set, const geom::Transform& pose, double error) : set_(&set) {
  place(pose, error);
}

void PosedSet::place(const geom::Transform& pose, double error) {
  detail::RotationDefect defect;
  detail::rotation_defect(pose, 1e-9, defect);
  if (!defect.is_rotation)
    throw Error(ErrorCode::InvalidArgument, "a pose whose matrix is no rotation");
  const auto is_near = [](double along) { return std::abs(along) <= kFarthest; };
  const Vec3& t = pose.translation;
  if (!is_near(t[0]) || !is_near(t[1]) || !is_near(t[2]))
    throw Error(ErrorCode::InvalidArgument, "a pose with numbers beyond 1e60");
  const double wrong = require_length(error, "an error of its place");
  pose_ = pose;
  error_ = wrong;
  defect_ = bound_of_defect(pose.linear, defect.square);
}

Box3 PosedSet::box(std::size_t i) const { return body(i).box((radius_above(i) + error_) * kSumUp); }

std::vector<Box3> PosedSet::boxes() const {
  std::vector<Box3> out;
  out.reserve(set_->size());
  for (std::size_t i = 0; i < set_->size(); ++i) out.push_back(box(i));
  return out;
}

Box3 PosedSet::box() const {
  if (set_->size() == 0) return {};
  const Vec3 middle = 0.5 * set_->box().min + 0.5 * set_->box().max;
  const Vec3 half = 0.5 * set_->box().max - 0.5 * set_->box().min;
  // Radii may be stretched by what the box is not; and what all of this rounds by.
  const double rounding =
      0x1p-48 * (middle.cwiseAbs().sum() + half.sum() + pose_.translation.cwiseAbs().sum());
  const double grown = (error_ + 4 * defect_ * half.sum()) * kSumUp + rounding;
  const Vec3 at = pose_ * middle, reach = pose_.linear.cwiseAbs() * half + Vec3::Constant(grown);
  Box3 out;
  out.extend(Vec3(at - reach));
  out.extend(Vec3(at + reach));
  return out;
}

}  // namespace kaboum::collide
