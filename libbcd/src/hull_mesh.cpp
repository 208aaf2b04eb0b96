// Triangles of a hull while vertices are put in the place of others.

#include "hull_mesh.h"

#include <algorithm>

namespace kaboum::bcd {

using geom::Triangle;
using geom::Vec3;

HullMesh::HullMesh(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles)
    : vertices_(points), star_(points.size()), version_(points.size(), 0), count_(points.size()) {
  for (const Triangle& t : triangles) add_triangle(t);
}

void HullMesh::add_triangle(const Triangle& t) {
  const auto index = static_cast<Index>(triangles_.size());
  triangles_.push_back(t);
  state_.push_back(State::Alive);
  for (const Index v : t) star_[v].push_back(index);
}

bool HullMesh::adjacent(Index a, Index b) const {
  for (const Index t : star_[a])
    for (const Index v : triangles_[t])
      if (v == b) return true;
  return false;
}

bool HullMesh::link(Index a, Index b, std::vector<Edge>& edges) const {
  edges.clear();
  int both = 0;
  for (const Index x : {a, b}) {
    for (const Index t : star_[x]) {
      const Triangle& v = triangles_[t];
      const bool has_a = v[0] == a || v[1] == a || v[2] == a;
      const bool has_b = v[0] == b || v[1] == b || v[2] == b;
      if (has_a && has_b) {
        ++both;
        continue;
      }
      int k = 0;
      while (v[k] != x) ++k;
      edges.push_back({v[(k + 1) % 3], v[(k + 2) % 3]});
    }
  }
  return both == 4 && edges.size() >= 3;
}

HullMesh::Index HullMesh::across(Index a, Index b) const {
  for (const Index t : star_[star_[a].size() < star_[b].size() ? a : b]) {
    const Triangle& w = triangles_[t];
    if (alive(t) &&
        ((w[0] == b && w[1] == a) || (w[1] == b && w[2] == a) || (w[2] == b && w[0] == a)))
      return t;
  }
  return kNone;
}

bool HullMesh::mark(Index t) {
  if (!alive(t)) return false;
  state_[t] = State::Marked;
  return true;
}

void HullMesh::unmark(std::span<const Index> marked) {
  for (const Index t : marked) state_[t] = State::Alive;
}

std::optional<std::vector<HullMesh::Index>> HullMesh::ring_round(
    std::span<const Index> marked) const {
  std::vector<Edge> horizon;
  for (const Index t : marked) {
    const Triangle& v = triangles_[t];
    for (int k = 0; k < 3; ++k)
      if (across(v[k], v[(k + 1) % 3]) != kNone) horizon.push_back({v[k], v[(k + 1) % 3]});
  }
  if (horizon.size() < 3) return std::nullopt;
  // One loop: every vertex once.
  std::vector<Index> ring{horizon[0][0]};
  std::sort(horizon.begin(), horizon.end());
  while (ring.size() <= horizon.size()) {
    const auto next = std::lower_bound(horizon.begin(), horizon.end(), Edge{ring.back(), 0});
    if (next == horizon.end() || (*next)[0] != ring.back() ||
        (next + 1 != horizon.end() && (*(next + 1))[0] == ring.back()))
      return std::nullopt;
    if ((*next)[1] == ring[0]) break;
    ring.push_back((*next)[1]);
  }
  if (ring.size() != horizon.size()) return std::nullopt;
  return ring;
}

HullMesh::Index HullMesh::replace(std::span<const Index> marked, const std::vector<Index>& ring,
                                  const Vec3& position, std::vector<Index>& vanished) {
  std::vector<Index> corners;
  for (const Index t : marked)
    for (const Index v : triangles_[t]) corners.push_back(v);
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (const Index t : marked) state_[t] = State::Gone;
  for (const Index v : corners)
    std::erase_if(star_[v], [&](Index t) { return state_[t] == State::Gone; });
  const auto fresh = static_cast<Index>(vertices_.size());
  vertices_.push_back(position);
  star_.emplace_back();
  version_.push_back(0);
  for (std::size_t i = 0; i < ring.size(); ++i)
    add_triangle({ring[i], ring[(i + 1) % ring.size()], fresh});
  ++count_;
  vanished.clear();
  for (const Index v : corners) {
    if (used(v)) {
      ++version_[v];
    } else {
      --count_;
      vanished.push_back(v);
    }
  }
  return fresh;
}

}  // namespace kaboum::bcd
