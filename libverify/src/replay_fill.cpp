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

using Corners = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Of triangles with the same corners, as many of one orientation as it has more of than the other.
std::vector<Corners> without_opposite_pairs(const std::vector<Corners>& triangles) {
  std::map<Corners, std::int64_t> surplus;  // beginning with the smallest corner, then the middle
  for (Corners c : triangles) {
    std::rotate(c.begin(), std::ranges::min_element(c), c.end());
    const bool even = c[1] < c[2];
    if (!even) std::swap(c[1], c[2]);
    surplus[c] += even ? 1 : -1;
  }
  std::vector<Corners> out;
  for (const auto& [c, n] : surplus)
    out.insert(out.end(), static_cast<std::size_t>(n < 0 ? -n : n),
               n > 0 ? c : Corners{c[0], c[2], c[1]});
  return out;
}

/// The boundary of the triangles, reversed: directed edges to be filled, each with its component
/// (triangles joined by edges).
class Holes {
 public:
  explicit Holes(const std::vector<Corners>& triangles) : component_(triangles.size()) {
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

  /// Fills them once, if they are to be filled, of one component, and pass no vertex twice.
  /// @return whether they are.
  bool take(const std::vector<std::uint32_t>& rim) {
    if (rim.size() < 3 || std::set(rim.begin(), rim.end()).size() != rim.size()) return false;
    std::vector<std::int64_t*> left;
    std::optional<std::size_t> component;
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const auto at = open_.find({rim[k], rim[(k + 1) % rim.size()]});
      if (at == open_.end() || at->second.first == 0) return false;
      if (component.value_or(at->second.second) != at->second.second) return false;
      component = at->second.second;
      left.push_back(&at->second.first);
    }
    for (std::int64_t* n : left) --*n;
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

}  // namespace

std::string find_wrong_rim(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                           const std::vector<std::vector<std::uint32_t>>& rims) {
  if (rims.empty()) return {};
  Holes holes(without_opposite_pairs(triangles));
  for (std::size_t i = 0; i < rims.size(); ++i)
    if (!holes.take(rims[i]))
      return "what is filled is no hole, the " + std::to_string(i + 1) + ". of the log";
  return {};
}

}  // namespace kaboum::verify
