#include "obstacle.h"

#include <cmath>
#include <limits>

namespace kaboum::wrap {

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
