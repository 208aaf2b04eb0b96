#include "proximity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kaboum::bmesh {

Proximity::Proximity(const geom::Mesh& mesh)
    : mesh_(mesh), bvh_(std::make_shared<const geom::Bvh>(mesh)) {
  triangles_.reserve(mesh.triangles.size());
  ball_.reserve(mesh.triangles.size());
  for (const std::uint32_t i : bvh_->order()) {
    triangles_.push_back(mesh.triangles[i]);
    const std::array<Vec3, 3> c = corners(static_cast<std::uint32_t>(triangles_.size() - 1));
    geom::Box3 box;
    for (const Vec3& p : c) box.extend(p);
    const Eigen::Vector3f middle = box.center().cast<float>();
    double squared = 0;
    for (const Vec3& p : c) squared = std::max(squared, (p - middle.cast<double>()).squaredNorm());
    // Upwards, of the smallest, too.
    const auto radius = static_cast<float>((1 + 1e-6) * std::sqrt(squared));
    ball_.push_back({middle, std::nextafter(radius, std::numeric_limits<float>::infinity())});
  }
}

double Proximity::squared(const Vec3& p, std::uint32_t& hint, double enough) const {
  const auto nodes = bvh_->nodes();
  const auto to_box = [&](const geom::Box3& box) {
    return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm();
  };
  if (hint >= triangles_.size()) hint = 0;
  double best = squared_distance(p, corners(hint)), root = std::sqrt(best);
  struct Entry {
    double squared;
    std::uint32_t node;
  };
  std::array<Entry, geom::Bvh::kMaxDepth> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0 && best > enough) {
    const Entry entry = stack[--size];
    if (entry.squared >= best) continue;
    std::uint32_t index = entry.node;
    while (!nodes[index].leaf()) {
      Entry near{to_box(nodes[index + 1].box), index + 1};
      Entry far{to_box(nodes[nodes[index].first].box), nodes[index].first};
      if (far.squared < near.squared) std::swap(near, far);
      if (near.squared >= best) break;
      if (far.squared < best) stack[size++] = far;
      index = near.node;
    }
    const geom::Bvh::Node& node = nodes[index];
    if (!node.leaf()) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double reach = root + ball_[i].radius;
      if ((p - ball_[i].middle.cast<double>()).squaredNorm() > reach * reach) continue;
      const double d = squared_distance(p, corners(i));
      if (d >= best) continue;
      best = d;
      root = std::sqrt(d);
      hint = i;
    }
  }
  return best;
}

}  // namespace kaboum::bmesh
