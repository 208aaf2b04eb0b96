// The tree of boxes that exact queries use is binary and in double precision. Here four boxes at a
// time are compared, and four triangles, in single precision, which decides nothing but where to
// look.
#include "closest_triangle.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/topology.h>

#include <array>
#include <bit>
#include <limits>

namespace kaboum::bmesh {

namespace {

constexpr std::uint32_t kLeaf = 1U << 31;

}  // namespace

ClosestTriangle::ClosestTriangle(const geom::Mesh& mesh)
    : mesh_(mesh), bvh_(std::make_shared<const geom::Bvh>(mesh)) {
  triangles_.reserve(mesh.triangles.size());
  for (const std::uint32_t i : bvh_->order()) triangles_.push_back(mesh.triangles[i]);
  frame_ = Frame(bvh_->nodes().front().box);
  find_neighbours();  // first, for it takes room for a while
  root_ = add(0);
}

/// Places of the triangles across edges that two have.
void ClosestTriangle::find_neighbours() {
  std::vector<std::uint32_t> place(triangles_.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[triangle(i)] = i;
  across_.resize(triangles_.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) across_[i].fill(i);
  const std::vector<geom::EdgeUse> uses = geom::edge_uses(mesh_);
  geom::for_each_edge(uses, [&](std::span<const geom::EdgeUse> e) {
    if (e.size() != 2) return;
    across_[place[e[0].triangle]][e[0].corner] = place[e[1].triangle];
    across_[place[e[1].triangle]][e[1].corner] = place[e[0].triangle];
  });
}

ClosestTriangle::Found ClosestTriangle::walk(const Vec3& p, std::uint32_t place, double enough,
                                             double& squared) const {
  constexpr int kMostSteps = 12;
  Found best{place, std::numeric_limits<double>::infinity()};
  for (std::uint32_t at = place, from = place, i = 0; i <= kMostSteps; ++i) {
    const auto [a, b, c] = corners(at);
    const geom::ClosestPoint closest = geom::closest_and_beyond(p, a, b, c);
    const double d = (p - closest.point).squaredNorm();
    if (i == 0) squared = d;
    if (d > best.squared) break;
    best = {at, d};
    if (closest.beyond < 0 || !(d > enough)) break;
    const std::uint32_t next = across_[at][static_cast<std::size_t>(closest.beyond)];
    if (next == at || next == from) break;
    from = at;
    at = next;
  }
  return best;
}

/// Makes a node of the tree's node: of up to four nodes below it, or a leaf. @return its place
std::uint32_t ClosestTriangle::add(std::uint32_t index) {
  const auto nodes = bvh_->nodes();
  if (nodes[index].leaf()) {
    const geom::Bvh::Node& from = nodes[index];
    ensure(from.count <= 4, "a leaf of more than four triangles");
    Leaf leaf{{}, from.first, (1U << from.count) - 1};
    for (std::uint32_t i = 0; i < from.count; ++i)
      leaf.triangles.put(static_cast<int>(i), corners(from.first + i), frame_);
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
    const geom::Box3& box = nodes[below[i]].box;
    const Eigen::Vector3f low = frame_(box.min), high = frame_(box.max);
    const std::uint32_t child = add(below[i]);
    for (int k = 0; k < 3; ++k) {
      nodes_[place].low[k][i] = low[k];
      nodes_[place].high[k][i] = high[k];
    }
    nodes_[place].child[i] = child;
  }
  return place;
}

double ClosestTriangle::squared(const Vec3& p, std::uint32_t& hint, double enough,
                                std::uint64_t* steps) const {
  if (hint >= triangles_.size()) hint = 0;
  double best = 0;
  Found near = walk(p, hint, enough, best);
  if (enough > 0 && !(near.squared > enough)) {
    hint = near.place;
    return near.squared;
  }
  // The walk only says how near the nearest is at most: which of several that are equally near is
  // found does not depend on it.
  float cutoff = frame_.cutoff(near.squared);
  const Eigen::Vector3f x = frame_(p);
  struct Entry {
    float squared;
    std::uint32_t node;
  };
  std::array<Entry, 3 * geom::Bvh::kMaxDepth + 1> stack;
  std::size_t size = 0;
  stack[size++] = {0, root_};
  std::uint64_t visited = 1;
  while (size > 0 && best > enough) {
    const Entry entry = stack[--size];
    if (!(entry.squared < cutoff)) continue;
    ++visited;
    if ((entry.node & kLeaf) != 0) {
      const Leaf& leaf = leaves_[entry.node & ~kLeaf];
      const Float4 bound = leaf.triangles.at_least(x);
      for (unsigned bits = bits_below(bound, cutoff) & leaf.all; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(bits));
        if (!(bound[i] < cutoff)) continue;
        const double d = squared_distance(p, corners(leaf.first + i));
        if (d >= best) continue;
        best = d;
        hint = leaf.first + i;
        if (!(d < near.squared)) continue;
        near = {hint, d};
        cutoff = frame_.cutoff(d);
      }
      continue;
    }
    const Node& node = nodes_[entry.node];
    const auto away = [&](int k) {
      return larger(larger(node.low[k] - x[k], x[k] - node.high[k]), Float4{});
    };
    const Float4 dx = away(0), dy = away(1), dz = away(2);
    const Float4 bound = dx * dx + dy * dy + dz * dz;
    // The nearest comes last.
    const std::size_t first = size;
    for (unsigned bits = bits_below(bound, cutoff); bits != 0; bits &= bits - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(bits));
      std::size_t at = size++;
      for (; at > first && stack[at - 1].squared < bound[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {bound[i], node.child[i]};
    }
  }
  constexpr std::uint64_t kNode = 30;
  if (steps != nullptr) *steps += kNode * visited;
  if (near.squared < best) {  // far from all, single precision may have passed it over
    hint = near.place;
    best = near.squared;
  }
  return best;
}

}  // namespace kaboum::bmesh
