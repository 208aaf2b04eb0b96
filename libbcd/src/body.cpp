// Bodies as unions of nodes of the tree of cuts, and hulls round two of them.

#include "body.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace kaboum::bcd {
namespace {

constexpr std::uint64_t kUnionWork = 2000;  ///< of looking at a pair at all [ns]
constexpr double kNear = 1e-3;              ///< boxes nearer than this share of the diagonal touch

geom::HullBuilder& hull_builder() {
  static thread_local geom::HullBuilder builder;
  return builder;
}

void join(const Body& a, const Body& b, std::vector<Vec3>& points) {
  points.assign(a.hull.begin(), a.hull.end());
  points.insert(points.end(), b.hull.begin(), b.hull.end());
}

/// Distance of some points between the bodies: the largest, or one beyond `limit`.
double between(const Body& a, const Body& b, const SolidField& solid, double limit) {
  constexpr std::size_t kSamples = 48, kStride = 11;
  double worst = 0;
  for (std::size_t i = 0; i < kSamples && worst <= limit; ++i) {
    const Vec3& p = a.hull[i * a.hull.size() / kSamples];
    const Vec3& q = b.hull[(i * kStride % kSamples) * b.hull.size() / kSamples];
    const Vec3 middle = 0.5 * (p + q);
    worst = std::max(worst, solid.distance_above(worst, middle, solid.field(middle)));
  }
  return worst;
}

Body body_round(const std::vector<Vec3>& points, const SolidField& solid, std::vector<int> leaves) {
  Body body;
  geom::HullBuilder& builder = hull_builder();
  body.concavity = estimate_concavity(points, solid, builder);
  if (body.concavity.flat) {
    body.hull = points;
  } else {
    for (const std::uint32_t v : builder.vertices()) body.hull.push_back(points[v]);
  }
  for (const Vec3& p : body.hull) body.box.extend(p);
  body.leaves = std::move(leaves);
  return body;
}

std::vector<int> children_of(const CutTree& tree, int node) {
  std::vector<int> out;
  tree.append_children(node, out);
  return out;
}

}  // namespace

Body body_of(const CutTree& tree, int leaf) {
  const CutTree::Node& node = tree.nodes()[leaf];
  Body body{node.hull, {leaf}, node.concavity, {}};
  for (const Vec3& p : body.hull) body.box.extend(p);
  return body;
}

Body union_of(const CutTree& tree, const SolidField& solid, const std::vector<int>& leaves) {
  std::vector<Vec3> points;
  for (const int leaf : leaves) {
    const std::vector<Vec3>& hull = tree.nodes()[leaf].hull;
    points.insert(points.end(), hull.begin(), hull.end());
  }
  return body_round(points, solid, leaves);
}

Body union_of(const Body& a, const Body& b, const SolidField& solid) {
  std::vector<Vec3> points;
  join(a, b, points);
  std::vector<int> leaves = a.leaves;
  leaves.insert(leaves.end(), b.leaves.begin(), b.leaves.end());
  std::sort(leaves.begin(), leaves.end());
  return body_round(points, solid, std::move(leaves));
}

double worst_of(const std::vector<Body>& bodies) {
  double worst = 0;
  for (const Body& b : bodies) worst = std::max(worst, b.concavity.worst);
  return worst;
}

bool touch(const Body& a, const Body& b, const SolidField& solid) {
  const double near = kNear * solid.diagonal();
  return ((a.box.min.array() - near <= b.box.max.array()) &&
          (b.box.min.array() - near <= a.box.max.array()))
      .all();
}

double distance_from_below(const Body& a, const Body& b, const SolidField& solid, double limit) {
  solid.work().add(kUnionWork);
  const double own = std::max(a.concavity.worst, b.concavity.worst);
  return own > limit ? own : std::max(own, between(a, b, solid, limit));
}

UnionEstimate estimate_union(const Body& a, const Body& b, const SolidField& solid, double limit) {
  const double least = distance_from_below(a, b, solid, limit);
  return least > limit ? UnionEstimate{least, 0, false} : estimate_hull(a, b, solid, limit);
}

UnionEstimate estimate_hull(const Body& a, const Body& b, const SolidField& solid, double limit) {
  static thread_local std::vector<Vec3> points;
  join(a, b, points);
  const Concavity h = estimate_concavity(points, solid, hull_builder(), true, limit);
  const double added = std::max(0.0, h.volume - a.concavity.volume - b.concavity.volume);
  return {h.worst, std::cbrt(added), h.worst <= limit};
}

std::optional<SolidField::Witness> far_point(const Body& body, const SolidField& solid,
                                             double limit) {
  geom::HullBuilder& builder = hull_builder();
  if (body.concavity.flat || !builder.build(body.hull)) return std::nullopt;
  const double weight = body.concavity.weight;
  auto far = far_point(body.hull, solid, builder, limit / weight);
  if (far) far->distance *= weight;
  return far;
}

std::vector<int> leaves_of(const CutTree& tree, const Body& body) {
  std::vector<int> out;
  for (const int node : body.leaves) tree.leaves_below(node, out);
  return out;
}

std::vector<int> nodes_of(const CutTree& tree, const Body& body, std::size_t least,
                          double distance) {
  const auto& nodes = tree.nodes();
  const std::vector<int> leaves = leaves_of(tree, body);
  std::set<int, std::greater<>> whole(leaves.begin(), leaves.end());
  // Parents come before their children in the tree, and so after them here.
  for (auto it = whole.begin(); it != whole.end(); ++it) {
    const int parent = nodes[*it].parent;
    if (parent < 0) continue;
    const std::vector<int> parts = children_of(tree, parent);
    if (std::all_of(parts.begin(), parts.end(), [&](int part) { return whole.contains(part); }))
      whole.insert(parent);
  }
  std::vector<int> coarsest;
  for (const int node : whole)
    if (!whole.contains(nodes[node].parent)) coarsest.push_back(node);
  std::vector<int> out = tree.nodes_within(distance, std::move(coarsest));
  while (out.size() < least) {
    auto largest = out.end();
    for (auto it = out.begin(); it != out.end(); ++it)
      if (!tree.is_leaf(*it) &&
          (largest == out.end() || nodes[*it].concavity.volume > nodes[*largest].concavity.volume))
        largest = it;
    if (largest == out.end()) break;
    const std::vector<int> parts = children_of(tree, *largest);
    out.erase(largest);
    out.insert(out.end(), parts.begin(), parts.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<int> nodes_of(const CutTree& tree, const Body& a, const Body& b) {
  std::vector<int> out = nodes_of(tree, a, 1);
  for (const int node : nodes_of(tree, b, 1)) out.push_back(node);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace kaboum::bcd
