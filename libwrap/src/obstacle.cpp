#include "obstacle.h"

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

}  // namespace kaboum::wrap
