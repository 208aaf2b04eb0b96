// Of the binary tree of boxes in double precision, a tree of four boxes a node in single precision.

#include <kaboum/base/error.h>
#include <kaboum/geom/wide_bvh.h>

namespace kaboum::geom {

WideBvh::WideBvh(const Mesh& mesh, const Bvh& bvh) {
  if (bvh.empty()) return;
  frame_ = UnitFrame(bvh.nodes().front().box);
  root_ = add(mesh, bvh, 0);
}

/// Makes a node of the tree's node: of up to four nodes below it, or a leaf. @return its place
std::uint32_t WideBvh::add(const Mesh& mesh, const Bvh& bvh, std::uint32_t index) {
  const auto nodes = bvh.nodes();
  if (nodes[index].leaf()) {
    const Bvh::Node& from = nodes[index];
    ensure(from.count <= 4, "a leaf of more than four triangles");
    Leaf leaf{{}, from.first, (1U << from.count) - 1};
    for (std::uint32_t i = 0; i < from.count; ++i) {
      const Triangle& t = mesh.triangles[bvh.order()[from.first + i]];
      leaf.triangles.put(static_cast<int>(i),
                         {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, frame_);
    }
    leaves_.push_back(leaf);
    return kLeaf | static_cast<std::uint32_t>(leaves_.size() - 1);
  }
  std::array<std::uint32_t, 4> below{index + 1, nodes[index].first};
  int count = 0;
  for (const std::uint32_t side : {index + 1, nodes[index].first}) {
    if (nodes[side].leaf()) {
      below[count++] = side;
      continue;
    }
    below[count++] = side + 1;
    below[count++] = nodes[side].first;
  }
  const auto place = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  for (int i = 0; i < count; ++i) {
    const Box3& box = nodes[below[i]].box;
    const Eigen::Vector3f low = frame_(box.min), high = frame_(box.max);
    const std::uint32_t child = add(mesh, bvh, below[i]);
    for (int k = 0; k < 3; ++k) {
      nodes_[place].low[k][i] = low[k];
      nodes_[place].high[k][i] = high[k];
    }
    nodes_[place].child[i] = child;
  }
  return place;
}

std::uint64_t WideBvh::gather(const Vec3& center, double radius, Vicinity& out) const {
  out.center_ = center;
  out.radius_ = radius;
  out.leaves_.clear();
  constexpr Float4 kNone = Node::kAllFar;
  constexpr float kFar = Node::kFar;
  if (nodes_.empty()) {  // one leaf at most, which is taken to be everywhere
    constexpr Float4 low{-kFar, kFar, kFar, kFar};
    if (!leaves_.empty()) out.leaves_.push_back({{low, low, low}, {-low, -low, -low}, {}});
    return 1;
  }
  const Eigen::Vector3f x = frame_(center);
  const float cutoff = frame_.cutoff(radius * radius);
  std::array<std::uint32_t, 3 * Bvh::kMaxDepth + 1> stack;
  std::size_t size = 0;
  stack[size++] = root_;
  std::uint64_t visited = 0;
  unsigned last = 4;  // leaves among the last four
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    ++visited;
    const Float4 bound = squared_distance(node.low, node.high, x);
    for (unsigned bits = bits_below(bound, cutoff); bits != 0; bits &= bits - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(bits));
      if ((node.child[i] & kLeaf) == 0) {
        stack[size++] = node.child[i];
        continue;
      }
      if (last == 4) {
        out.leaves_.push_back({{kNone, kNone, kNone}, {-kNone, -kNone, -kNone}, {}});
        last = 0;
      }
      Vicinity::FourLeaves& to = out.leaves_.back();
      for (int k = 0; k < 3; ++k) {
        to.low[k][last] = node.low[k][i];
        to.high[k][last] = node.high[k][i];
      }
      to.leaf[last++] = node.child[i] & ~kLeaf;
    }
  }
  return visited;
}

}  // namespace kaboum::geom
