// What closed forms take of bodies.

#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kaboum::collide::detail {
namespace {

using geom::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The edges of a box from its first corner on, longest first, if these are its corners, about.
std::optional<std::array<Vec3, 3>> edges_of(const std::vector<Vec3>& corners) {
  std::array<Vec3, 7> way;
  for (std::size_t i = 0; i < 7; ++i) way[i] = corners[i + 1] - corners[0];
  const auto far = std::ranges::max_element(way, {}, [](const Vec3& v) { return v.squaredNorm(); });
  std::swap(*far, way[6]);
  // The three edges are square to each other, and lead to the opposite corner together.
  double least = kInfinity;
  std::array<Vec3, 3> best;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i + 1; j < 6; ++j)
      for (std::size_t k = j + 1; k < 6; ++k) {
        const double off = std::abs(way[i].dot(way[j])) + std::abs(way[j].dot(way[k])) +
                           std::abs(way[k].dot(way[i])) +
                           (way[i] + way[j] + way[k] - way[6]).squaredNorm();
        if (!(off < least)) continue;
        least = off;
        best = {way[i], way[j], way[k]};
      }
  if (!(least < 1e-2 * way[6].squaredNorm())) return std::nullopt;
  std::ranges::sort(best, std::greater{}, [](const Vec3& v) { return v.squaredNorm(); });
  return best;
}

/// Makes a box of eight corners that are those of one, up to little.
bool fit_box(const std::vector<Vec3>& corners, Shape& out) {
  const auto edges = edges_of(corners);
  if (!edges) return false;
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : corners) center += 0.125 * p;
  Eigen::Matrix3d axes;
  axes.col(0) = (*edges)[0].normalized();
  axes.col(1) = ((*edges)[1] - axes.col(0).dot((*edges)[1]) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1)).normalized();
  Vec3 half = Vec3::Zero();
  double size = 0;
  for (const Vec3& p : corners) {
    half += 0.125 * (axes.transpose() * (p - center)).cwiseAbs();
    size = std::max(size, p.lpNorm<1>());
  }
  double deviation = 0;
  unsigned seen = 0;
  for (const Vec3& p : corners) {
    const Vec3 at = axes.transpose() * (p - center);
    unsigned which = 0;
    Vec3 corner = center;
    for (int k = 0; k < 3; ++k) {
      which |= (at[k] > 0 ? 1U : 0U) << k;
      corner += (at[k] > 0 ? half[k] : -half[k]) * axes.col(k);
    }
    seen |= 1U << which;
    deviation = std::max(deviation, (p - corner).norm());
  }
  deviation += 0x1p-44 * size;
  if (seen != 0xff || !axes.allFinite() || !(deviation < 0x1p-6 * half.minCoeff())) return false;
  out.kind = Shape::Kind::Box;
  out.center = center;
  out.axes = axes;
  out.half = half;
  out.deviation = deviation;
  return true;
}

/// Not below x.
float above(double x) { return static_cast<float>(x * (1 + 0x1p-22)); }

void fill_lane(const Shape& shape, const Vec3& origin, std::size_t lane, Lanes& out) {
  const auto set = [&](std::size_t row, const Vec3& v) {
    for (int k = 0; k < 3; ++k)
      out.row[row + static_cast<std::size_t>(k)][lane] = static_cast<float>(v[k]);
  };
  double size = 0;
  if (shape.kind == Shape::Kind::Round) {
    const Vec3 p = shape.ends[0] - origin, q = shape.ends[1] - origin;
    set(Lanes::kFirst, p);
    set(Lanes::kSecond, q);
    size = std::max(p.lpNorm<1>(), q.lpNorm<1>());
  } else {
    set(Lanes::kCenter, shape.center - origin);
    for (int k = 0; k < 3; ++k)
      set(Lanes::kAxes + 3 * static_cast<std::size_t>(k), shape.axes.col(k));
    set(Lanes::kHalf, shape.half);
    size = (shape.center - origin).lpNorm<1>() + shape.half.sum();
    out.row[Lanes::kOuter][lane] = above(shape.deviation);
    out.row[Lanes::kInner][lane] = shape.kind == Shape::Kind::Box
                                       ? above(shape.deviation)
                                       : std::numeric_limits<float>::infinity();
  }
  out.row[Lanes::kRadius][lane] = static_cast<float>(shape.radius);
  out.row[Lanes::kSize][lane] = above(size + shape.radius);
}

}  // namespace

Shape shape_of(const geom::ConvexBody& body) {
  Shape out;
  out.radius = body.radius;
  const std::vector<Vec3>& points = body.core.vertices;
  if (points.size() <= 2) {
    out.kind = Shape::Kind::Round;
    out.ends = {points.front(), points.back()};
    out.center = 0.5 * points.front() + 0.5 * points.back();
    return out;
  }
  if (points.size() == 8 && fit_box(points, out)) return out;
  geom::Box3 box;
  for (const Vec3& p : points) box.extend(p);
  out.center = 0.5 * box.min + 0.5 * box.max;
  out.half = 0.5 * box.max - 0.5 * box.min;
  out.deviation = 0x1p-50 * (box.min.cwiseAbs().sum() + box.max.cwiseAbs().sum());
  return out;
}

Shapes::Shapes(const std::vector<geom::ConvexBody>& bodies, const geom::Box3& box) {
  if (bodies.empty()) return;
  constexpr double kSmallest = 1e-9, kLargest = 1e8;
  origin = 0.5 * box.min + 0.5 * box.max;
  half = 0.5 * box.max - 0.5 * box.min;
  reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).sum();
  const double size = (box.max - box.min).sum();
  in_floats = size >= kSmallest && size <= kLargest;
  shape.reserve(bodies.size());
  for (const geom::ConvexBody& body : bodies) shape.push_back(shape_of(body));
  for (const bool round : {true, false}) {
    for (std::uint32_t i = 0; i < shape.size(); ++i) {
      if ((shape[i].kind == Shape::Kind::Round) != round) continue;
      if (lanes.empty() || lanes.back().are_round != round || lanes.back().count == Lanes::kCount)
        lanes.emplace_back().are_round = round;
      Lanes& last = lanes.back();
      for (std::size_t lane = last.count; lane < Lanes::kCount; ++lane) {
        last.body[lane] = i;
        if (in_floats) fill_lane(shape[i], origin, lane, last);
      }
      last.box.extend(geom::bounding_box(bodies[i]));
      ++last.count;
    }
  }
}

}  // namespace kaboum::collide::detail
