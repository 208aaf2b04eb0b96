#include "obstacle.h"

#include <kaboum/geom/point_triangle.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::wrap {
namespace {

using Polygon = std::vector<Vec3>;

/// The parts of a convex polygon on either side of a plane: where n·x ≤ d, and the rest.
std::pair<Polygon, Polygon> cut(const Polygon& polygon, const Vec3& n, double d) {
  std::pair<Polygon, Polygon> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double of_a = n.dot(a) - d, of_b = n.dot(b) - d;
    if (of_a <= 0) out.first.push_back(a);
    if (of_a >= 0) out.second.push_back(a);
    if (of_a * of_b >= 0) continue;
    const Vec3 p = a + of_a / (of_a - of_b) * (b - a);
    out.first.push_back(p);
    out.second.push_back(p);
  }
  return out;
}

/// Whether a polygon is as good as a line.
bool is_thin(const Polygon& polygon, double width) {
  if (polygon.size() < 3) return true;
  Vec3 twice_area = Vec3::Zero();
  double longest = 0;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const Vec3 way = polygon[i] - polygon[0];
    longest = std::max(longest, way.norm());
    if (i > 1) twice_area += (polygon[i - 1] - polygon[0]).cross(way);
  }
  return twice_area.norm() <= width * longest;
}

bool is_within(const Polygon& polygon, double radius, const Corners& t) {
  return std::ranges::all_of(polygon, [&](const Vec3& p) {
    return geom::point_triangle_upper(p, t[0], t[1], t[2]) <= radius;
  });
}

/// Cuts a polygon across, in the middle of its longest edge.
std::pair<Polygon, Polygon> halves(const Polygon& polygon) {
  std::size_t longest = 0;
  const auto edge = [&](std::size_t i) {
    return Vec3(polygon[(i + 1) % polygon.size()] - polygon[i]);
  };
  for (std::size_t i = 1; i < polygon.size(); ++i)
    if (edge(i).squaredNorm() > edge(longest).squaredNorm()) longest = i;
  const Vec3 along = edge(longest);
  return cut(polygon, along, along.dot(polygon[longest] + 0.5 * along));
}

}  // namespace

Obstacle::Obstacle(const geom::Mesh& mesh, double clearance)
    : query_(mesh), clearance_(clearance) {}

bool Obstacle::clear(std::span<const Tetrahedron> tetrahedra) const {
  if (tetrahedra.empty()) return true;
  thread_local Cones cones;
  cones.set(tetrahedra, clearance_);
  const auto nodes = query_.hierarchy().nodes();
  const auto order = query_.hierarchy().order();
  std::uint32_t stack[geom::Bvh::kMaxDepth];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const geom::Bvh::Node& node = nodes[index];
    if (!cones.may_meet(node.box)) continue;
    if (!node.leaf()) {
      stack[size++] = node.first;
      stack[size++] = index + 1;
      continue;
    }
    if (!cones.choose(node.box)) continue;
    for (const std::uint32_t triangle : order.subspan(node.first, node.count))
      if (!cones.clear_of(query_.corners(triangle))) return false;
  }
  return true;
}

// The distance from one triangle is convex: its largest value on a polygon is at a corner. What is
// not near to the triangle nearest to the middle is cut off along the triangle's edges.
bool Obstacle::covers(Polygon polygon, double radius, std::uint32_t hint) const {
  constexpr std::size_t kMostPieces = 100;
  std::vector<Polygon> pieces{std::move(polygon)};
  for (std::size_t looked = 0; !pieces.empty(); ++looked) {
    if (looked == kMostPieces) return false;
    Polygon piece = std::move(pieces.back());
    pieces.pop_back();
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : piece) middle += p / static_cast<double>(piece.size());
    if (!within(middle, radius, hint)) return false;
    const Corners& t = query_.corners(hint);
    if (is_within(piece, radius, t)) continue;
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const std::size_t left = pieces.size();
    for (std::size_t k = 0; k < 3 && !piece.empty(); ++k) {
      const Vec3 out = (t[(k + 1) % 3] - t[k]).cross(normal);
      auto [inside, outside] = cut(piece, out, out.dot(t[k]));
      if (!is_thin(outside, 1e-9 * radius)) pieces.push_back(std::move(outside));
      piece = std::move(inside);
    }
    if (!is_thin(piece, 1e-9 * radius)) {
      if (!is_within(piece, radius, t)) return false;
      continue;
    }
    // Beside the triangle.
    if (pieces.size() == left + 1) {
      auto [first, second] = halves(pieces.back());
      pieces.back() = std::move(first);
      pieces.push_back(std::move(second));
    }
  }
  return true;
}

Foot Obstacle::rough_foot(const Vec3& p, std::uint32_t hint) const {
  Foot best{Vec3::Zero(), 0, hint};
  double squared = std::numeric_limits<double>::infinity(), limit = squared;
  const auto consider = [&](std::uint32_t triangle) {
    const Corners& t = query_.corners(triangle);
    if (geom::box_beyond(p, t, std::sqrt(limit))) return;
    const Vec3 point = geom::nearest_point(p, t[0], t[1], t[2]);
    const double found = (p - point).squaredNorm();
    if (!(found < squared)) return;
    squared = found;
    limit = kRough * kRough * squared;
    best.point = point;
    best.triangle = triangle;
  };
  consider(hint);
  const auto distance = [&](const geom::Box3& box) {
    return (box.min - p).cwiseMax(p - box.max).cwiseMax(0).squaredNorm();
  };
  const auto nodes = query_.hierarchy().nodes();
  const auto order = query_.hierarchy().order();
  struct Entry {
    double squared;
    std::uint32_t node;
  };
  Entry stack[geom::Bvh::kMaxDepth];
  int size = 0;
  stack[size++] = {distance(nodes[0].box), 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.squared < limit)) continue;
    const geom::Bvh::Node& node = nodes[entry.node];
    if (node.leaf()) {
      for (const std::uint32_t triangle : order.subspan(node.first, node.count)) consider(triangle);
      continue;
    }
    Entry near{distance(nodes[entry.node + 1].box), entry.node + 1};
    Entry far{distance(nodes[node.first].box), node.first};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < limit) stack[size++] = far;
    if (near.squared < limit) stack[size++] = near;
  }
  best.distance = std::sqrt(squared);
  return best;
}

}  // namespace kaboum::wrap
