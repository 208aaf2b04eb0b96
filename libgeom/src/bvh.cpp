#include <kaboum/geom/bvh.h>

#include <algorithm>
#include <numeric>

namespace kaboum::geom {
namespace {

constexpr std::uint32_t kLeafSize = 4;

struct Builder {
  std::vector<Bvh::Node>& nodes;
  std::vector<std::uint32_t>& order;
  const std::vector<Box3>& boxes;

  void build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t self = nodes.size();
    nodes.emplace_back();
    Box3 box, center_box;
    for (std::uint32_t i = begin; i < end; ++i) {
      box.extend(boxes[order[i]]);
      center_box.extend(boxes[order[i]].center());
    }
    nodes[self].box = box;
    if (end - begin <= kLeafSize) {
      nodes[self].first = begin;
      nodes[self].count = end - begin;
      return;
    }
    int axis = 0;
    (center_box.max - center_box.min).maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto center = [&](std::uint32_t i) {
      return 0.5 * boxes[i].min[axis] + 0.5 * boxes[i].max[axis];
    };
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const double ca = center(a), cb = center(b);
                       return ca < cb || (ca == cb && a < b);
                     });
    build(begin, middle);
    nodes[self].first = static_cast<std::uint32_t>(nodes.size());
    nodes[self].count = 0;
    build(middle, end);
  }
};

}  // namespace

Bvh::Bvh(const Mesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  if (n == 0) return;
  std::vector<Box3> boxes(n);
  for (std::uint32_t i = 0; i < n; ++i)
    for (const std::uint32_t v : mesh.triangles[i]) boxes[i].extend(mesh.vertices[v]);
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(2 * (n / (kLeafSize / 2) + 1));
  Builder{nodes_, order_, boxes}.build(0, n);
}

}  // namespace kaboum::geom
