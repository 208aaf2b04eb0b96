// Clusters of neighbouring triangles, for comparison. Source: [mamou2009], HACD.

#include "clusters.h"

#include <kaboum/geom/topology.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <queue>

namespace kaboum::bcd {
namespace {

struct Cluster {
  std::vector<Vec3> hull;  // vertices
  double area = 0, perimeter = 0, concavity = 0;
  std::map<std::uint32_t, double> shared;  // neighbour → length of the common border
  std::uint32_t parent = 0;                // itself while it lives
};

struct Edge {
  double cost;
  std::uint32_t a, b;
  bool known;  ///< else the cost is a lower bound: hulls only grow away from the solid
  double concavity;
  bool operator<(const Edge& o) const {
    if (cost != o.cost) return cost > o.cost;
    return a != o.a ? a > o.a : b > o.b;
  }
};

class DualGraph {
 public:
  DualGraph(const SolidField& solid, double epsilon) : solid_(solid), epsilon_(epsilon) {
    const double concavity = std::min(epsilon, 0.01 * solid.diagonal());
    shape_ = concavity / 10;  // [mamou2009] § 3.3
    const Mesh& mesh = solid.mesh();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Cluster c;
      for (const std::uint32_t v : mesh.triangles[t]) c.hull.push_back(mesh.vertices[v]);
      c.area = 0.5 * (c.hull[1] - c.hull[0]).cross(c.hull[2] - c.hull[0]).norm();
      c.perimeter = (c.hull[1] - c.hull[0]).norm() + (c.hull[2] - c.hull[1]).norm() +
                    (c.hull[0] - c.hull[2]).norm();
      c.parent = t;
      clusters_.push_back(std::move(c));
    }
    const std::vector<geom::EdgeUse> uses = geom::edge_uses(mesh);
    for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
      if (uses[i].lo != uses[i + 1].lo || uses[i].hi != uses[i + 1].hi ||
          uses[i].triangle == uses[i + 1].triangle)
        continue;
      const double length = (mesh.vertices[uses[i].lo] - mesh.vertices[uses[i].hi]).norm();
      const std::uint32_t s = uses[i].triangle, t = uses[i + 1].triangle;
      clusters_[s].shared[t] += length;
      clusters_[t].shared[s] += length;
    }
    for (std::uint32_t t = 0; t < clusters_.size(); ++t)
      for (const auto& [n, length] : clusters_[t].shared)
        if (t < n) push(t, n);
  }

  void contract(std::size_t target) {
    for (std::size_t count = clusters_.size(); count > target && !queue_.empty();) {
      Edge e = queue_.top();
      queue_.pop();
      if (clusters_[e.a].parent != e.a || clusters_[e.b].parent != e.b) continue;
      if (e.known) {
        join(e);
        --count;
        continue;
      }
      join_hulls(e);
      const double concavity = std::max(
          e.concavity, estimate_concavity(points_, solid_, builder_, true, epsilon_).worst);
      if (concavity <= epsilon_)
        queue_.push({e.cost - e.concavity + concavity, e.a, e.b, true, concavity});
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> labels() const {
    std::vector<std::uint32_t> out(solid_.mesh().triangles.size());
    for (std::uint32_t t = 0; t < out.size(); ++t) {
      std::uint32_t c = t;
      while (clusters_[c].parent != c) c = clusters_[c].parent;
      out[t] = c;
    }
    return out;
  }

 private:
  void join_hulls(const Edge& e) {
    points_ = clusters_[e.a].hull;
    points_.insert(points_.end(), clusters_[e.b].hull.begin(), clusters_[e.b].hull.end());
  }

  void push(std::uint32_t i, std::uint32_t j) {
    const Cluster &a = clusters_[i], &b = clusters_[j];
    const double area = a.area + b.area, border = a.perimeter + b.perimeter - 2 * a.shared.at(j);
    const double roundness = area > 0 ? border * border / (4 * std::numbers::pi * area) : 1e9;
    const double concavity = std::max(a.concavity, b.concavity);
    queue_.push({concavity + shape_ * roundness, i, j, false, concavity});
  }

  void join(const Edge& e) {
    const auto [a, b] = std::pair(e.a, e.b);
    const auto self = static_cast<std::uint32_t>(clusters_.size());
    Cluster c;
    c.parent = self;
    c.area = clusters_[a].area + clusters_[b].area;
    c.perimeter = clusters_[a].perimeter + clusters_[b].perimeter - 2 * clusters_[a].shared.at(b);
    c.concavity = e.concavity;
    join_hulls(e);
    if (!estimate_concavity(points_, solid_, builder_, true, 0).flat) {
      for (const std::uint32_t v : builder_.vertices()) c.hull.push_back(points_[v]);
    } else {
      c.hull = points_;
    }
    for (const std::uint32_t part : {a, b}) {
      clusters_[part].parent = self;
      clusters_[part].hull = {};
      for (const auto& [n, length] : clusters_[part].shared) {
        if (n == a || n == b) continue;
        c.shared[n] += length;
        clusters_[n].shared.erase(part);
        clusters_[n].shared[self] += length;
      }
      clusters_[part].shared = {};
    }
    clusters_.push_back(std::move(c));
    for (const auto& [n, length] : clusters_[self].shared) push(n, self);
  }

  const SolidField& solid_;
  double epsilon_, shape_ = 0;
  std::vector<Cluster> clusters_;
  std::priority_queue<Edge> queue_;
  geom::HullBuilder builder_;
  std::vector<Vec3> points_;
};

/// The cluster with the largest area in the piece.
std::uint32_t owner(const Piece& piece, const SolidField& solid,
                    const std::vector<std::uint32_t>& cluster) {
  std::map<std::uint32_t, double> area;
  for (std::size_t f = 0; f < piece.polygons(); ++f) {
    Vec3 twice = Vec3::Zero();
    const Vec3& a = piece.points[piece.corner[piece.start[f]]];
    for (std::uint32_t k = piece.start[f] + 1; k + 1 < piece.start[f + 1]; ++k)
      twice += (piece.points[piece.corner[k]] - a).cross(piece.points[piece.corner[k + 1]] - a);
    area[cluster[piece.source[f]]] += twice.norm();
  }
  if (area.empty()) return cluster[solid.surface().nearest(piece.cell.center()).triangle];
  return std::max_element(area.begin(), area.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

std::vector<std::uint32_t> cluster_triangles(const SolidField& solid, std::size_t target,
                                             double epsilon) {
  DualGraph graph(solid, epsilon);
  graph.contract(target);
  return graph.labels();
}

std::vector<Body> bodies_of_clusters(const CutTree& tree, const SolidField& solid,
                                     const std::vector<std::uint32_t>& cluster) {
  std::map<std::uint32_t, std::vector<int>> leaves;
  for (const int leaf : tree.leaves())
    leaves[owner(tree.nodes()[leaf].piece, solid, cluster)].push_back(leaf);
  std::vector<Body> out;
  out.reserve(leaves.size());
  for (const auto& [number, of_cluster] : leaves) out.push_back(union_of(tree, solid, of_cluster));
  return out;
}

}  // namespace kaboum::bcd
