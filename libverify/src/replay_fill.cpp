// Checks how a decimation log fills holes. Part of the checker, so it uses neither the preparation
// nor its adjacency.

#include "replay_fill.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace kaboum::verify {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The boundary of the triangles, reversed: directed edges to be filled, each with its component
/// (triangles joined by edges).
class Holes {
 public:
  explicit Holes(const std::vector<std::array<std::uint32_t, 3>>& triangles)
      : component_(triangles.size()) {
    std::iota(component_.begin(), component_.end(), std::size_t{0});
    std::map<Edge, std::pair<std::int64_t, std::size_t>> edges;  // balance, a triangle
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        auto& [balance, first] = edges.try_emplace(std::minmax(a, b), 0, t).first->second;
        balance += a < b ? 1 : -1;
        component_[root(t)] = root(first);
      }
    for (const auto& [edge, use] : edges) {
      const auto& [balance, triangle] = use;
      const Edge reversed = balance > 0 ? Edge{edge.second, edge.first} : edge;
      if (balance != 0) open_[reversed] = {balance > 0 ? balance : -balance, root(triangle)};
    }
  }

  /// Whether the edges are to be filled, of one component, and pass no vertex twice.
  [[nodiscard]] bool has(const std::vector<Edge>& rim) const {
    std::set<std::uint32_t> corners;
    std::optional<std::size_t> component;
    for (const Edge& edge : rim) {
      const auto at = open_.find(edge);
      if (at == open_.end() || at->second.first == 0) return false;
      if (component.value_or(at->second.second) != at->second.second) return false;
      component = at->second.second;
      if (!corners.insert(edge.first).second) return false;
    }
    return true;
  }
  /// Fills them once. @return whether it has them.
  bool take(const std::vector<Edge>& rim) {
    if (!has(rim)) return false;
    for (const Edge& edge : rim) --open_.at(edge).first;
    return true;
  }

 private:
  std::size_t root(std::size_t t) {
    while (component_[t] != t) t = component_[t] = component_[component_[t]];
    return t;
  }

  std::vector<std::size_t> component_;
  std::map<Edge, std::pair<std::int64_t, std::size_t>> open_;  // how often, component
};

/// Triangles with one corner in common, the tip, as preparing makes them: {loop[k], loop[k + 1],
/// tip} or, turned, {loop[k], tip, loop[k + 1]}. Where the tip is on the loop, two are missing.
class Fan {
 public:
  /// The longest fan of triangles from `first` on.
  Fan(const std::vector<geom::Triangle>& fill, std::size_t first, bool turned)
      : turned_(turned), tip_(fill[first][turned ? 1 : 2]) {
    for (std::size_t i = first; i < fill.size() && fill[i][turned ? 1 : 2] == tip_; ++i) {
      const Edge edge{fill[i][0], fill[i][turned ? 2 : 1]};
      if (!edges_.empty() && edges_.back().second != edge.first) {
        if (gap_ != 0) break;
        gap_ = edges_.size();
      }
      edges_.push_back(edge);
      if (closed()) break;
    }
    if (!closed()) {  // the tip comes first or last, and what follows a gap is another fan
      if (gap_ != 0) edges_.resize(gap_);
      gap_ = edges_.size();
    }
  }

  [[nodiscard]] std::size_t triangles() const { return edges_.size(); }
  [[nodiscard]] std::uint32_t tip() const { return tip_; }

  /// The loop's vertices, in its order.
  [[nodiscard]] std::vector<std::uint32_t> loop() const {
    std::vector<std::uint32_t> out;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      out.push_back(edges_[k].first);
      if (k + 1 == gap_) {
        out.push_back(edges_[k].second);
        out.push_back(tip_);
      }
    }
    return out;
  }

  /// Whether the tip is the mean of the loop, beginning with it or ending with it if it is there.
  template <class PointOf>
  [[nodiscard]] bool begins_at_mean(const PointOf& point) const {
    std::vector<std::uint32_t> rim = loop();
    for (int turn = 0; turn < 2; ++turn) {
      geom::Vec3 mean = geom::Vec3::Zero();
      for (const std::uint32_t v : rim) mean += point(v) / static_cast<double>(rim.size());
      if (mean == point(tip_)) return true;
      std::rotate(rim.begin(), rim.end() - 1, rim.end());
    }
    return false;
  }

  /// Of the rim, as the fan's triangles run through them.
  [[nodiscard]] std::vector<Edge> rim() const {
    const std::vector<std::uint32_t> vertices = loop();
    std::vector<Edge> out;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const std::uint32_t a = vertices[k], b = vertices[(k + 1) % vertices.size()];
      out.push_back(turned_ ? Edge{b, a} : Edge{a, b});
    }
    return out;
  }

 private:
  [[nodiscard]] bool closed() const { return edges_.back().second == edges_.front().first; }

  bool turned_;
  std::uint32_t tip_;
  std::vector<Edge> edges_;  // of the loop, in its order
  std::size_t gap_ = 0;      // after so many edges comes the tip; 0: it is not on the loop
};

}  // namespace

std::string find_wrong_fill(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                            const std::vector<geom::Vec3>& points, const bmesh::Log& log) {
  const std::vector<geom::Triangle>& fill = log.filled_triangles;
  std::vector<char> used(log.filled_vertices.size(), 0);
  if (fill.empty() && used.empty()) return {};
  const auto point = [&](std::uint32_t v) -> const geom::Vec3& {
    return v < points.size() ? points[v] : log.filled_vertices[v - points.size()];
  };
  Holes holes(triangles);
  for (std::size_t i = 0; i < fill.size();) {
    const std::string what = "triangle " + std::to_string(i) + " of those that fill holes ";
    const geom::Triangle& t = fill[i];
    std::vector<Edge> rim{{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}};
    std::size_t count = 1;
    if (!holes.has(rim)) {
      const Fan fans[] = {{fill, i, false}, {fill, i, true}};
      const Fan* fan = std::ranges::find_if(
          fans, [&](const Fan& f) { return f.loop().size() > 3 && f.begins_at_mean(point); });
      if (fan == std::end(fans))
        return what + "is no hole, and begins no fan round a loop from its mean";
      rim = fan->rim();
      count = fan->triangles();
      if (fan->tip() >= points.size()) used[fan->tip() - points.size()] = 1;
    }
    if (!holes.take(rim)) return what + "is, or begins a fan, on edges that are no hole's";
    i += count;
  }
  if (std::ranges::find(used, 0) != used.end()) return "a vertex that is to fill a hole does not";
  return {};
}

}  // namespace kaboum::verify
