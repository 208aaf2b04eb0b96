#pragma once

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/bcd/inner.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd::test {

/// Little effort, epsilon in percent of the diagonal.
template <class Options = CoverOptions>
Options quick(const geom::Mesh& mesh, double epsilon_percent, std::size_t max_vertices = 64) {
  Options options;
  options.epsilon = 0.01 * epsilon_percent * geom::bounding_box(mesh).diagonal();
  options.max_vertices = max_vertices;
  options.effort = Effort::Fast;
  return options;
}
inline InnerOptions quick_inner(const geom::Mesh& mesh, double epsilon_percent,
                                std::size_t max_vertices = 64) {
  return quick<InnerOptions>(mesh, epsilon_percent, max_vertices);
}

/// Calls visit(family, prepared) with every family of closed solids of at most `largest` triangles.
inline void for_each_solid(
    std::size_t largest,
    const std::function<void(const kaboum::test::Family&, const geom::Prepared&)>& visit) {
  for (const auto& family : kaboum::test::closed_families()) {
    if (!family.solid || family.mesh.triangles.size() > largest) continue;
    SCOPED_TRACE(family.name);
    std::optional<geom::Prepared> prepared;
    try {
      prepared = geom::prepare(family.mesh);
    } catch (const Error&) {
      continue;  // sheets
    }
    visit(family, *prepared);
  }
}

/// Whether p lies in one of the bodies, by the slow oracle, which shares nothing with the library.
inline bool covered(const std::vector<geom::ConvexBody>& bodies, const geom::Vec3& p) {
  return std::any_of(bodies.begin(), bodies.end(), [&](const geom::ConvexBody& body) {
    const auto w = kaboum::test::winding_number_slow(body.core, p);
    return !w || *w == 1;
  });
}

inline geom::ConvexSet set_of(const std::vector<geom::ConvexBody>& bodies) {
  geom::ConvexSet set;
  set.bodies = bodies;
  return set;
}

inline verify::Answer cover_of(const geom::Mesh& mesh, const geom::ConvexSet& set) {
  const verify::Cover cover = verify::verify_cover(mesh, set);
  for (const auto answer : {cover.convexity.convex.answer, cover.inclusion.solid.answer,
                            cover.inclusion.surface.answer})
    if (answer != verify::Answer::Verified) return answer;
  return verify::Answer::Verified;
}

/// What is claimed of every body: exactly convex, float32, not too many vertices.
inline void expect_bodies(const std::vector<geom::ConvexBody>& bodies, std::size_t max_vertices) {
  EXPECT_FALSE(geom::find_not_convex(set_of(bodies)).has_value());
  for (const geom::ConvexBody& body : bodies) {
    EXPECT_LE(body.core.vertices.size(), max_vertices);
    for (const geom::Vec3& p : body.core.vertices) EXPECT_TRUE(geom::is_float32(p));
  }
}

/// All that is claimed of bodies that cover.
inline void expect_cover(const geom::Mesh& mesh, const CoverCandidate& result,
                         std::size_t max_vertices) {
  expect_bodies(result.bodies, max_vertices);
  EXPECT_LE(result.excess_lower, result.excess_upper);
  EXPECT_EQ(cover_of(mesh, set_of(result.bodies)), verify::Answer::Verified);
}

/// Prism over a simple polygon given counter-clockwise, from z = 0 to `height`.
inline geom::Mesh prism(const std::vector<std::array<double, 2>>& polygon, double height) {
  geom::Mesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double z : {0.0, height})
    for (const auto& p : polygon) mesh.vertices.emplace_back(p[0], p[1], z);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  // Ears.
  std::vector<std::uint32_t> rest(n);
  for (std::uint32_t i = 0; i < n; ++i) rest[i] = i;
  const auto area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return (polygon[b][0] - polygon[a][0]) * (polygon[c][1] - polygon[a][1]) -
           (polygon[b][1] - polygon[a][1]) * (polygon[c][0] - polygon[a][0]);
  };
  while (rest.size() >= 3) {
    bool cut = false;
    for (std::size_t k = 0; k < rest.size() && !cut; ++k) {
      const std::uint32_t a = rest[k], b = rest[(k + 1) % rest.size()],
                          c = rest[(k + 2) % rest.size()];
      if (area(a, b, c) <= 0) continue;
      bool empty = true;
      for (const std::uint32_t p : rest)
        if (p != a && p != b && p != c)
          empty = empty && (area(a, b, p) < 0 || area(b, c, p) < 0 || area(c, a, p) < 0);
      if (!empty) continue;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({n + a, n + b, n + c});
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>((k + 1) % rest.size()));
      cut = true;
    }
    if (!cut) break;
  }
  return mesh;
}

/// Corners of regular polygons in turn: `count` of them, on the circles of these radii, from the
/// angle of half a step on.
inline std::vector<std::array<double, 2>> ring(int count, const std::vector<double>& radii) {
  std::vector<std::array<double, 2>> out;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / count;
    const double r = radii[static_cast<std::size_t>(i) % radii.size()];
    out.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return out;
}

/// The boundary of the cells of a grid for which `filled` holds, given by its planes across every
/// axis: two triangles per cell face, exactly planar.
inline geom::Mesh lattice_solid(const std::array<std::vector<double>, 3>& planes,
                                const std::function<bool(int, int, int)>& filled) {
  const std::array<int, 3> cells{static_cast<int>(planes[0].size()) - 1,
                                 static_cast<int>(planes[1].size()) - 1,
                                 static_cast<int>(planes[2].size()) - 1};
  const auto in = [&](const std::array<int, 3>& c) {
    for (std::size_t k = 0; k < 3; ++k)
      if (c[k] < 0 || c[k] >= cells[k]) return false;
    return filled(c[0], c[1], c[2]);
  };
  geom::Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> number;
  const auto vertex = [&](const std::array<int, 3>& c) {
    const auto [at, fresh] = number.emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh)
      mesh.vertices.emplace_back(planes[0][static_cast<std::size_t>(c[0])],
                                 planes[1][static_cast<std::size_t>(c[1])],
                                 planes[2][static_cast<std::size_t>(c[2])]);
    return at->second;
  };
  std::array<int, 3> c{};
  for (c[0] = 0; c[0] < cells[0]; ++c[0])
    for (c[1] = 0; c[1] < cells[1]; ++c[1])
      for (c[2] = 0; c[2] < cells[2]; ++c[2]) {
        if (!in(c)) continue;
        for (std::size_t k = 0; k < 3; ++k)
          for (const int side : {0, 1}) {
            std::array<int, 3> next = c;
            next[k] += 2 * side - 1;
            if (in(next)) continue;
            const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
            std::array<std::uint32_t, 4> q{};
            for (std::size_t i = 0; i < 4; ++i) {
              std::array<int, 3> at = c;
              at[k] += side;
              at[u] += i == 1 || i == 2 ? 1 : 0;
              at[v] += i >= 2 ? 1 : 0;
              q[i] = vertex(at);
            }
            if (side == 0) std::swap(q[1], q[3]);
            mesh.triangles.push_back({q[0], q[1], q[2]});
            mesh.triangles.push_back({q[0], q[2], q[3]});
          }
      }
  return mesh;
}

}  // namespace kaboum::bcd::test
