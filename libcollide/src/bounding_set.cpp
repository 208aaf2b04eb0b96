// Sets of bodies, and sets at their places.

#include <kaboum/base/error.h>
#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lengths.h"
#include "twos.h"

namespace kaboum::collide {
namespace {

using detail::kSumUp;
using detail::require_length;
using detail::Two;
using detail::Twos;
using geom::Box3;
using geom::Vec3;

constexpr double kFarthest = 1e60;  ///< as Posed takes it

/// LᵀL − I
Eigen::Matrix3d defect_of(const Eigen::Matrix3d& l) {
  const auto product = [&](int i, int j) {
    return l(0, i) * l(0, j) + l(1, i) * l(1, j) + l(2, i) * l(2, j);
  };
  const double xy = product(0, 1), xz = product(0, 2), yz = product(1, 2);
  Eigen::Matrix3d out;
  out << product(0, 0) - 1, xy, xz, xy, product(1, 1) - 1, yz, xz, yz, product(2, 2) - 1;
  return out;
}

double determinant(const Eigen::Matrix3d& l) {
  return l(0, 0) * (l(1, 1) * l(2, 2) - l(2, 1) * l(1, 2)) -
         l(0, 1) * (l(1, 0) * l(2, 2) - l(2, 0) * l(1, 2)) +
         l(0, 2) * (l(1, 0) * l(2, 1) - l(2, 0) * l(1, 1));
}

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
double bound_of_defect(const Eigen::Matrix3d& l, const Eigen::Matrix3d& defect) {
  if (swaps_axes(l)) return 0;
  return defect.norm() + 0x1p-47;
}

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
  rows_.resize(10 * stride());
  for (std::size_t i = 0; i < stride() && !bodies_.empty(); ++i) {
    const std::size_t body = std::min(i, size() - 1);
    const Box3& box = polytopes_[body].box();
    const Vec3 middle = box.center(), half = 0.5 * box.max - 0.5 * box.min;
    for (int k = 0; k < 3; ++k) {
      rows_[k * stride() + i] = middle[k];
      rows_[(3 + k) * stride() + i] = half[k];
      rows_[(6 + k) * stride() + i] = polytopes_[body].magnitude()[k];
    }
    rows_[9 * stride() + i] = bodies_[body].radius;
  }
}

BoundingSet::BoundingSet(const geom::ConvexSet& set)
    : BoundingSet(bodies_of(set), direction_of(set), epsilon_of(set)) {}

PosedSet::PosedSet(const BoundingSet& set, const geom::Transform& pose, double error) : set_(&set) {
  std::size_t size = 6 * set.stride();
  for (std::size_t count = set.size(); count > kBlock;) {
    count = (count + kBlock - 1) / kBlock;
    levels_.push_back({size, count});
    size += 6 * count;
  }
  boxes_ = std::make_shared<std::vector<double>>(size);
  place(pose, error);
}

void PosedSet::place_blocks() {
  const double* below = boxes_->data();
  std::size_t stride = set_->stride(), many = set_->size();
  for (const Level& level : levels_) {
    double* at = boxes_->data() + level.from;
    for (std::size_t row = 0; row < 6; ++row)
      for (std::size_t i = 0; i < level.count; ++i) {
        const double* first = below + row * stride + i * kBlock;
        const double* last = first + std::min(kBlock, many - i * kBlock);
        at[row * level.count + i] =
            row < 3 ? *std::min_element(first, last) : *std::max_element(first, last);
      }
    below = at;
    stride = many = level.count;
  }
}

void PosedSet::place(const geom::Transform& pose, double error) {
  const Eigen::Matrix3d defect = defect_of(pose.linear);
  if (!(defect.cwiseAbs().maxCoeff() < 1e-9) || !(determinant(pose.linear) > 0))
    throw Error(ErrorCode::InvalidArgument, "a pose whose matrix is no rotation");
  if (!pose.translation.allFinite() || !(pose.translation.cwiseAbs().maxCoeff() <= kFarthest))
    throw Error(ErrorCode::InvalidArgument, "a pose with numbers beyond 1e60");
  pose_ = pose;
  error_ = require_length(error, "an error of its place");
  defect_ = bound_of_defect(pose.linear, defect);
  box_ = {};
  if (set_->size() == 0) return;
  if (boxes_.use_count() > 1) boxes_ = std::make_shared<std::vector<double>>(boxes_->size());
  const std::size_t stride = set_->stride();
  const Twos radius{set_->row(9)};
  for (std::size_t k = 0; k < 3; ++k) {
    // Posed::box, for two bodies at once.
    const double x = pose.linear(k, 0), y = pose.linear(k, 1), z = pose.linear(k, 2),
                 t = pose.translation[k];
    const double x_size = std::abs(x), y_size = std::abs(y), z_size = std::abs(z),
                 t_size = std::abs(t);
    const Twos middle[3] = {{set_->row(0)}, {set_->row(1)}, {set_->row(2)}},
               half[3] = {{set_->row(3)}, {set_->row(4)}, {set_->row(5)}},
               magnitude[3] = {{set_->row(6)}, {set_->row(7)}, {set_->row(8)}};
    double *low = boxes_->data() + k * stride, *high = low + 3 * stride;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Two least = Two{} + kInfinity, most = Two{} - kInfinity;
    for (std::size_t i = 0; i < stride; i += 2) {
      const Two at = x * middle[0][i] + y * middle[1][i] + z * middle[2][i] + t;
      const Two wide = x_size * half[0][i] + y_size * half[1][i] + z_size * half[2][i];
      const Two large =
          x_size * magnitude[0][i] + y_size * magnitude[1][i] + z_size * magnitude[2][i] + t_size;
      // Radius and error, rounded up.
      const Two reach = (radius[i] * (1 + defect_) + error) * kSumUp;
      const Two far = (wide + reach) * (1 + 0x1p-48) + 0x1p-48 * large + 0x1p-900;
      const Two from = at - far, to = at + far;
      std::memcpy(low + i, &from, sizeof from);
      std::memcpy(high + i, &to, sizeof to);
      least = from < least ? from : least;
      most = to > most ? to : most;
    }
    box_.min[k] = std::min(least[0], least[1]);
    box_.max[k] = std::max(most[0], most[1]);
  }
  place_blocks();
}

}  // namespace kaboum::collide
