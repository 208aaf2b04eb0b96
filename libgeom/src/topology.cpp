// Edges, components and manifoldness of a mesh, and its welded form.
#include <kaboum/base/parallel.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "union_find.h"

namespace kaboum::geom {
namespace {

bool repeated_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Vertices whose triangles, joined through shared edges at the vertex, form more than one group.
std::size_t count_nonmanifold_vertices(const Mesh& mesh, const std::vector<EdgeUse>& uses) {
  // Corners 3·triangle + k; an edge joins the corners of all its triangles at each of its ends.
  UnionFind groups(3 * mesh.triangles.size());
  const auto corner_at = [&](std::uint32_t triangle, std::uint32_t vertex) {
    const Triangle& t = mesh.triangles[triangle];
    const std::uint32_t k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    return 3 * triangle + k;
  };
  for_each_edge(uses, [&](std::span<const EdgeUse> e) {
    for (const EdgeUse& u : e.subspan(1))
      for (const std::uint32_t v : {u.lo, u.hi})
        groups.join(corner_at(e[0].triangle, v), corner_at(u.triangle, v));
  });
  std::vector<std::uint32_t> fans(mesh.vertices.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (repeated_corner(mesh.triangles[t])) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      if (groups.find(3 * t + k) == 3 * t + k) ++fans[mesh.triangles[t][k]];
  }
  return static_cast<std::size_t>(
      std::count_if(fans.begin(), fans.end(), [](std::uint32_t n) { return n > 1; }));
}

}  // namespace

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  return orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y()) == Sign::Zero &&
         orient2d(a.y(), a.z(), b.y(), b.z(), c.y(), c.z()) == Sign::Zero &&
         orient2d(a.z(), a.x(), b.z(), b.x(), c.z(), c.x()) == Sign::Zero;
}

std::vector<EdgeUse> edge_uses(const Mesh& mesh) {
  // Counting sort by the lower vertex, then small sorts.
  std::vector<std::uint32_t> start(mesh.vertices.size() + 1, 0);
  const auto each_side = [&](auto&& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& tri = mesh.triangles[t];
      if (repeated_corner(tri)) continue;
      for (std::uint8_t k = 0; k < 3; ++k) {
        const std::uint32_t a = tri[k], b = tri[(k + 1) % 3];
        visit(EdgeUse{std::min(a, b), std::max(a, b), t, k, a < b});
      }
    }
  };
  each_side([&](const EdgeUse& e) { ++start[e.lo + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<EdgeUse> uses(start.back());
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  each_side([&](const EdgeUse& e) { uses[next[e.lo]++] = e; });
  const auto sort_at = [&](std::size_t v) {
    std::sort(uses.begin() + start[v], uses.begin() + start[v + 1],
              [](const EdgeUse& a, const EdgeUse& b) {
                return a.hi < b.hi || (a.hi == b.hi && a.triangle < b.triangle);
              });
  };
  parallel_for(std::size_t{0}, mesh.vertices.size(), sort_at, {.grain = 4096});
  return uses;
}

std::vector<std::uint32_t> components(std::span<const EdgeUse> uses, std::size_t triangles,
                                      std::uint32_t* count) {
  UnionFind groups(triangles);
  for_each_edge(uses, [&](std::span<const EdgeUse> e) {
    for (const EdgeUse& u : e.subspan(1)) groups.join(e[0].triangle, u.triangle);
  });
  return groups.labels(count);
}

std::vector<std::uint32_t> components(const Mesh& mesh, bool through_edges, std::uint32_t* count) {
  if (through_edges) return components(edge_uses(mesh), mesh.triangles.size(), count);
  UnionFind groups(mesh.triangles.size());
  std::vector<std::uint32_t> first_at(mesh.vertices.size(), ~0U);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (first_at[v] == ~0U) first_at[v] = t;
      groups.join(first_at[v], t);
    }
  return groups.labels(count);
}

TopologyReport analyse(const Mesh& mesh) {
  TopologyReport report;
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = 1;
    if (is_degenerate(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]))
      ++report.degenerate_triangles;
  }
  report.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  report.triangles = mesh.triangles.size();
  std::uint32_t count = 0;
  components(mesh, false, &count);
  report.components = count;

  const std::vector<EdgeUse> uses = edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> e) {
    const std::size_t n = e.size();
    const auto forward = static_cast<std::size_t>(
        std::count_if(e.begin(), e.end(), [](const EdgeUse& u) { return u.forward; }));
    ++report.edges;
    report.open_edges += n == 1;
    report.nonmanifold_edges += n > 2;
    report.inconsistent_edges += n == 2 && forward != 1;
    report.unbalanced_edges += 2 * forward != n;
  });
  report.nonmanifold_vertices = count_nonmanifold_vertices(mesh, uses);

  std::vector<Triangle> keys;
  keys.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) keys.push_back(sorted(t));
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 1; i < keys.size(); ++i)
    report.duplicate_triangles += keys[i] == keys[i - 1];
  return report;
}

Mesh weld(const Mesh& mesh) {
  constexpr std::uint32_t kFree = ~0U;
  Mesh out;
  out.vertices.reserve(mesh.vertices.size());
  out.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), kFree);
  const std::size_t capacity = std::bit_ceil(2 * mesh.vertices.size() + 2);
  std::vector<std::uint32_t> table(capacity, kFree);
  const auto place = [&](Vec3 p) {
    p = p.array() + 0.0;  // −0 becomes +0
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k) {
      h ^= std::bit_cast<std::uint64_t>(p[k]);
      h *= 0x9E3779B97F4A7C15ULL;
      h ^= h >> 29;
    }
    for (std::size_t slot = h & (capacity - 1);; slot = (slot + 1) & (capacity - 1)) {
      if (table[slot] == kFree) {
        table[slot] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(p);
        return table[slot];
      }
      if (out.vertices[table[slot]] == p) return table[slot];
    }
  };
  for (const Triangle& t : mesh.triangles) {
    Triangle renamed;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& r = renumbered[t[k]];
      if (r == kFree) r = place(mesh.vertices[t[k]]);
      renamed[k] = r;
    }
    out.triangles.push_back(renamed);
  }
  return out;
}

}  // namespace kaboum::geom
