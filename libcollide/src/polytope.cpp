// Points of convex bodies, and bodies at their places.

#include <kaboum/base/error.h>
#include <kaboum/collide/polytope.h>

#include <algorithm>

#include "farthest.h"

namespace kaboum::collide {
namespace {

constexpr double kLargest = 1e60, kLargestFactor = 1e30;
/// Of coordinates that floats are used for.
constexpr double kSmallestFloat = 1e-10, kLargestFloat = 1e15;

}  // namespace

Polytope::Polytope(std::span<const geom::Vec3> points) {
  if (points.empty()) throw Error(ErrorCode::InvalidInput, "a convex body without points");
  for (const geom::Vec3& p : points) {
    if (!(p.cwiseAbs().maxCoeff() <= kLargest) || !p.allFinite())
      throw Error(ErrorCode::InvalidInput, "a convex body with coordinates beyond 1e60");
    x_.push_back(p.x());
    y_.push_back(p.y());
    z_.push_back(p.z());
    center_ += p / static_cast<double>(points.size());
    magnitude_ = magnitude_.cwiseMax(p.cwiseAbs());
    box_.extend(p);
  }
  const double largest = magnitude_.maxCoeff();
  if (!(largest >= kSmallestFloat && largest <= kLargestFloat)) return;
  for (std::size_t i = 0; i < points.size(); i += detail::kFloatsAtOnce)
    for (const std::vector<double>* axis : {&x_, &y_, &z_})
      for (std::size_t k = i; k < i + detail::kFloatsAtOnce; ++k)
        floats_.push_back(static_cast<float>((*axis)[std::min(k, points.size() - 1)]));
}

Posed::Posed(const Polytope& body, const geom::Transform& pose)
    : body_(&body),
      pose_(&pose),
      extent_(extent_of(body, pose)),
      magnitude_(extent_ + pose.translation.cwiseAbs()) {
  is_small_ = pose.linear.cwiseAbs().maxCoeff() <= 2;
  const bool small = pose.linear.cwiseAbs().maxCoeff() <= kLargestFactor &&
                     pose.translation.cwiseAbs().maxCoeff() <= kLargest;
  if (!small || !pose.linear.allFinite() || !pose.translation.allFinite())
    throw Error(ErrorCode::InvalidArgument, "a pose with numbers beyond 1e30");
}

geom::Box3 Posed::box(double reach) const {
  const geom::Vec3 center = *pose_ * body_->box().center();
  const geom::Vec3 half =
      pose_->linear.cwiseAbs() * (0.5 * body_->box().max - 0.5 * body_->box().min);
  // 2^-48 as in docs/algorithms/bounded-predicates.md, "Boxes"; the last term for underflow.
  const geom::Vec3 most = (half + geom::Vec3::Constant(reach)) * (1 + 0x1p-48) +
                          0x1p-48 * magnitude_ + geom::Vec3::Constant(0x1p-900);
  return {center - most, center + most};
}

}  // namespace kaboum::collide
