// How far points are from what a link sweeps: by many instants.

#include "swept_link.h"

#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::page {
namespace {

constexpr std::size_t kMostPerLeg = 40;  ///< instants looked at between two waypoints …
constexpr std::size_t kUsual = 400;      ///< … fewer of paths with more legs than a tenth of this
constexpr int kCloser = 9;               ///< steps of the golden section round the nearest of them

}  // namespace

SweptLink::SweptLink(const robot::Robot& robot, const robot::Path& path, std::uint32_t link,
                     const geom::Mesh& shapes)
    : robot_(robot),
      path_(path),
      link_(link),
      shapes_(shapes),
      per_leg_(std::clamp(kUsual / path.size(), std::size_t{1}, kMostPerLeg)) {
  const geom::Box3 box = geom::bounding_box(shapes);
  center_ = box.center();
  radius_ = 0.5 * box.diagonal();
  for (std::size_t i = 0; i <= (path.size() - 1) * per_leg_; ++i)
    poses_.push_back(pose_at(static_cast<double>(i) / static_cast<double>(per_leg_)));
}

geom::Transform SweptLink::pose_at(double instant) const {
  const auto last = static_cast<double>(path_.size() - 1);
  instant = std::clamp(instant, 0.0, last);
  const auto leg = static_cast<std::size_t>(std::min(std::floor(instant), std::max(0.0, last - 1)));
  std::vector<double> q = path_[leg];
  const double share = instant - static_cast<double>(leg);
  if (share > 0)
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += share * (path_[leg + 1][j] - q[j]);
  return robot::forward(robot_, q)[link_];
}

double SweptLink::distance_at(const geom::Transform& pose, const geom::Vec3& p) const {
  return shapes_.nearest(pose.linear.transpose() * (p - pose.translation)).upper;
}

double SweptLink::distance(const geom::Vec3& p) const {
  const auto least_at = [&](std::size_t i) { return (p - poses_[i] * center_).norm() - radius_; };
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < poses_.size(); ++i)
    if (const double here = least_at(i); here < least) {
      least = here;
      nearest = i;
    }
  double best = distance_at(poses_[nearest], p);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (!(least_at(i) < best)) continue;
    if (const double here = distance_at(poses_[i], p); here < best) {
      best = here;
      nearest = i;
    }
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1), step = 1.0 / static_cast<double>(per_leg_);
  double low = step * (static_cast<double>(nearest) - 1), high = low + 2 * step;  // of instants
  const auto at = [&](double instant) { return distance_at(pose_at(instant), p); };
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double of_a = at(a), of_b = at(b);
  for (int i = 0; i < kCloser; ++i) {
    best = std::min({best, of_a, of_b});
    if (of_a < of_b) {
      high = b;
      b = a;
      of_b = of_a;
      a = high - golden * (high - low);
      of_a = at(a);
    } else {
      low = a;
      a = b;
      of_a = of_b;
      b = low + golden * (high - low);
      of_b = at(b);
    }
  }
  return std::min({best, of_a, of_b});
}

}  // namespace kaboum::page
