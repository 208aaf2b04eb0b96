// The triangles around an edge that may be contracted, and whether the mesh
// would stay a surface.

#include "edge_star.h"

namespace kaboum::bmesh {

using geom::Triangle;

EdgeStar::EdgeStar(const WorkingMesh& mesh) : m_(mesh), mark_(mesh.position.size(), 0) {}

void EdgeStar::gather(std::uint32_t a, std::uint32_t b) {
  triangles.clear();
  rim.clear();
  m_.mesh.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) {
    const Triangle& tri = m_.mesh[t];
    triangles.push_back({t, k, false, tri[(k + 1) % 3] == b || tri[(k + 2) % 3] == b});
  });
  m_.mesh.for_each_triangle(b, [&](std::uint32_t t, std::uint32_t k) {
    const Triangle& tri = m_.mesh[t];
    if (tri[(k + 1) % 3] != a && tri[(k + 2) % 3] != a) triangles.push_back({t, k, true, false});
  });
}

void EdgeStar::gather(std::uint32_t v) {
  triangles.clear();
  rim.clear();
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
    triangles.push_back({t, k, false, false});
  });
}

/// Collects the triangles across the star's boundary: the new vertex must stay
/// on or below them.
void EdgeStar::gather_rim() {
  rim.clear();
  for (const StarTriangle& s : triangles) {
    if (s.vanishes) continue;
    const Triangle& t = m_.mesh[s.index];
    const std::uint32_t p = t[(s.corner + 1) % 3], q = t[(s.corner + 2) % 3];
    m_.mesh.for_each_triangle(q, [&](std::uint32_t u, std::uint32_t k) {
      if (m_.mesh[u][(k + 1) % 3] == p) rim.push_back(u);
    });
  }
}

/// The link condition: the neighbours common to a and b are the corners
/// opposite their edge, and no two triangles would come to coincide.
bool EdgeStar::keeps_topology(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t apex = ++mark_value_;
  std::uint32_t apexes = 0;
  for (const StarTriangle& s : triangles) {
    if (!s.vanishes) continue;
    for (const std::uint32_t v : m_.mesh[s.index]) {
      if (v == a || v == b || mark_[v] == apex) continue;
      mark_[v] = apex;
      ++apexes;
    }
  }
  if (apexes == 0) return false;
  const auto is_apex = [&](std::uint32_t v) { return mark_[v] == apex; };
  // Triangles between two apexes on both sides would fold onto each other.
  bool between[2] = {false, false};
  for (const StarTriangle& s : triangles) {
    if (s.vanishes) continue;
    const Triangle& t = m_.mesh[s.index];
    if (is_apex(t[(s.corner + 1) % 3]) && is_apex(t[(s.corner + 2) % 3])) between[s.at_b] = true;
  }
  if (between[0] && between[1]) return false;
  // Neighbours of a that are no apexes must not be neighbours of b.
  const std::uint32_t neighbour = ++mark_value_;
  bool common = false;
  for (const StarTriangle& s : triangles) {
    if (s.vanishes) continue;
    const Triangle& t = m_.mesh[s.index];
    for (std::uint32_t j = 1; j < 3; ++j) {
      const std::uint32_t v = t[(s.corner + j) % 3];
      if (is_apex(v)) continue;
      if (!s.at_b)
        mark_[v] = neighbour;
      else
        common = common || mark_[v] == neighbour;
    }
  }
  return !common;
}

void EdgeStar::describe(const Vec3& position, std::vector<std::uint32_t>& removed,
                        std::vector<NewTriangle>& added) const {
  removed.clear();
  added.clear();
  for (const StarTriangle& s : triangles) {
    removed.push_back(s.index);
    if (s.vanishes) continue;
    const Triangle& t = m_.mesh[s.index];
    added.push_back(
        {s.index,
         {position, m_.position[t[(s.corner + 1) % 3]], m_.position[t[(s.corner + 2) % 3]]}});
  }
}

const std::vector<std::uint32_t>& EdgeStar::neighbours(std::uint32_t v) {
  neighbours_.clear();
  const std::uint32_t seen = ++mark_value_;
  // Off borders every neighbour is the next corner of some triangle.
  const std::uint32_t corners = m_.border[v] == 0 ? 1 : 2;
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
    for (std::uint32_t j = 1; j <= corners; ++j) {
      const std::uint32_t w = m_.mesh[t][(k + j) % 3];
      if (mark_[w] == seen) continue;
      mark_[w] = seen;
      neighbours_.push_back(w);
    }
  });
  return neighbours_;
}

}  // namespace kaboum::bmesh
