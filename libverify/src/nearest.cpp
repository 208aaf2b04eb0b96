// Nearest triangles of a chain, and lower bounds of their distance by separating planes.
// docs/algorithms/exact-inclusion.md, "Distance".
#include "nearest.h"

#include "allowance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::verify {
namespace {

// What looking at one takes, in about nanoseconds.
constexpr std::uint64_t kBox = 15, kTriangle = 60;

Vec3 closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double square = d.squaredNorm();
  if (!(square > 0)) return a;
  const double t = std::clamp((p - a).dot(d) / square, 0.0, 1.0);
  return (1 - t) * a + t * b;
}

double squared_distance(const Vec3& p, const Bounds& box) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
    sum += d * d;
  }
  return sum;
}

}  // namespace

Vec3 closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  if (area > 0) {
    const double u = (c - b).cross(p - b).dot(n) / area;
    const double v = (a - c).cross(p - c).dot(n) / area;
    const double w = 1 - u - v;
    if (u >= 0 && v >= 0 && w >= 0) return u * a + v * b + w * c;
  }
  Vec3 best = closest_on_segment(p, a, b);
  for (const Vec3& q : {closest_on_segment(p, b, c), closest_on_segment(p, c, a)}) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

NearestTriangle::Hit NearestTriangle::nearest(const Vec3& p, std::uint32_t guess) const {
  Hit best{kNone, std::numeric_limits<double>::infinity()};
  if (tree_.empty()) return best;
  double square = std::numeric_limits<double>::infinity();
  std::uint64_t boxes = 0, triangles = 0;
  const auto look = [&](std::uint32_t f) {
    ++triangles;
    const double d = (closest_point(p, triangles_.corner(f, 0), triangles_.corner(f, 1),
                                    triangles_.corner(f, 2)) -
                      p)
                         .squaredNorm();
    if (d < square) {
      square = d;
      best.face = f;
    }
  };
  if (guess != kNone) look(guess);
  struct Entry {
    std::uint32_t node;
    double distance;
  };
  std::array<Entry, BoxTree::kMostLevels + 2> stack;
  std::size_t size = 0;
  stack[size++] = {0, squared_distance(p, tree_.nodes()[0].box)};
  while (size > 0) {
    const Entry entry = stack[--size];
    ++boxes;
    if (!(entry.distance < square)) continue;
    const BoxTree::Node& node = tree_.nodes()[entry.node];
    if (node.count == 0) {
      const Entry left{entry.node + 1, squared_distance(p, tree_.nodes()[entry.node + 1].box)};
      const Entry right{node.first, squared_distance(p, tree_.nodes()[node.first].box)};
      const bool left_first = left.distance <= right.distance;
      stack[size++] = left_first ? right : left;
      stack[size++] = left_first ? left : right;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (squared_distance(p, tree_.box(i)) < square) look(tree_.item(i));
    }
  }
  count_steps(kBox * boxes + kTriangle * triangles);
  best.distance = std::sqrt(square);
  return best;
}

double NearestTriangle::lower_bound_of(const Vec3& p, std::uint32_t triangle) const {
  const Vec3 &a = triangles_.corner(triangle, 0), &b = triangles_.corner(triangle, 1),
             &c = triangles_.corner(triangle, 2);
  const Vec3 away = p - closest_point(p, a, b, c);
  const double length = away.norm();
  if (!(length > 0)) return 0;
  const Vec3 n = away / length;
  return std::max(std::min({n.dot(p - a), n.dot(p - b), n.dot(p - c)}), 0.0);
}

double NearestTriangle::lower_bound(const Vec3& p, double within) const {
  // Triangles in boxes that are passed over are at least `within` away, up to rounding.
  double least = within;
  const double limit = within * within;
  std::uint64_t boxes = 0, triangles = 0;
  tree_.query([&](const Bounds& box) { return ++boxes, squared_distance(p, box) <= limit; },
              [&](std::uint32_t t) {
                ++triangles;
                least = std::min(least, lower_bound_of(p, t));
              });
  count_steps(kBox * boxes + kTriangle * triangles);
  return std::max(least, 0.0);
}

bool NearestTriangle::all_beyond(const Vec3& p, double radius) const {
  bool all = true;
  const double limit = radius * radius * (1 + 0x1p-48);
  tree_.query([&](const Bounds& box) { return all && squared_distance(p, box) <= limit; },
              [&](std::uint32_t t) { all = all && lower_bound_of(p, t) > radius; });
  return all;
}

double NearestTriangle::distance(const Vec3& p) const { return nearest(p).distance; }

}  // namespace kaboum::verify
