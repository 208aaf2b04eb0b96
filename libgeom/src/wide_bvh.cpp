// Of the binary tree of boxes in double precision, a tree of four boxes a node in single precision.

#include <kaboum/base/error.h>
#include <kaboum/geom/wide_bvh.h>

namespace kaboum::geom {

WideBvh::WideBvh(const Mesh& mesh, const Bvh& bvh) {
  if (bvh.empty()) return;
  frame_ = UnitFrame(bvh.nodes().front().box);
  const std::span<const std::uint32_t> order = bvh.order();
  ensure(order.size() < kMostTriangles, "too many triangles");
  packs_.resize((order.size() + 3) / 4);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Triangle& t = mesh.triangles[order[i]];
    packs_[i / 4].put(static_cast<int>(i % 4),
                      {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, frame_);
  }
  nodes_.reserve(wide_nodes(bvh, 0));
  root_ = add(bvh, 0);
}

namespace {

/// Those below a node and, where they are no leaves, those below them.
struct Below {
  std::array<std::uint32_t, 4> node;
  int count = 0;

  Below(std::span<const Bvh::Node> nodes, std::uint32_t index) : node{} {
    for (const std::uint32_t side : {index + 1, nodes[index].first}) {
      if (nodes[side].leaf()) {
        node[count++] = side;
        continue;
      }
      node[count++] = side + 1;
      node[count++] = nodes[side].first;
    }
  }
};

}  // namespace

/// Number of the nodes that `add` makes of a subtree.
std::size_t WideBvh::wide_nodes(const Bvh& bvh, std::uint32_t index) {
  if (bvh.nodes()[index].leaf()) return 0;
  std::size_t n = 1;
  const Below below(bvh.nodes(), index);
  for (int i = 0; i < below.count; ++i) n += wide_nodes(bvh, below.node[i]);
  return n;
}

/// Makes a node of the tree's node: of up to four nodes below it, or a leaf. @return its place
std::uint32_t WideBvh::add(const Bvh& bvh, std::uint32_t index) {
  const auto nodes = bvh.nodes();
  if (nodes[index].leaf()) {
    const Bvh::Node& from = nodes[index];
    ensure(from.count <= 4, "a leaf of more than four triangles");
    return kLeaf | (from.count - 1) << kOthers | from.first;
  }
  const Below below(nodes, index);
  const auto place = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  for (int i = 0; i < below.count; ++i) {
    const Box3& box = nodes[below.node[i]].box;
    const Eigen::Vector3f low = frame_(box.min), high = frame_(box.max);
    const std::uint32_t child = add(bvh, below.node[i]);
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
    if (!packs_.empty())
      out.leaves_.push_back({{low, low, low}, {-low, -low, -low}, {root_ & ~kLeaf}});
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
