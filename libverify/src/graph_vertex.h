#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh_pair.h"

// Vertices round which a surface is a graph over a plane: their triangles have nothing in common
// but edges and the vertex. docs/algorithms/exact-inclusion.md, "Loose triangles".
namespace kaboum::verify {

/// Sets a face's axis: that along which its projection is largest, by rounded arithmetic; −1 where
/// it has no area.
/// @return the directions ±x, ±y, ±z that it certainly faces, as bits
inline std::uint8_t set_axis(Face& face, const Vec3& a, const Vec3& b, const Vec3& c) {
  std::uint8_t faces = 0;
  double largest = 0;
  face.axis = -1;
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const double l = (a[u] - c[u]) * (b[v] - c[v]), r = (a[v] - c[v]) * (b[u] - c[u]);
    const double size = std::abs(l) + std::abs(r), value = l - r;
    if (!(size > 1e-280) || !(std::abs(value) > 4.5e-16 * size)) continue;
    faces |= static_cast<std::uint8_t>(1U << (2 * k + (value > 0 ? 0 : 1)));
    if (std::abs(value) <= largest) continue;
    largest = std::abs(value);
    face.axis = k;
    face.upward = value > 0;
  }
  if (face.axis >= 0) return faces;
  for (int k = 0; k < 3 && face.axis < 0; ++k) {
    const Sign sign = orient2d(k, a, b, c);
    if (sign == Sign::Zero) continue;
    face.axis = k;
    face.upward = sign == Sign::Positive;
  }
  return 0;
}

/// A triangle at a vertex: the vertices after and before it.
struct Spoke {
  std::uint32_t next, prev, face;
};

/// is_one_fan by sorting, for any number of triangles.
inline bool is_one_large_fan(std::span<const Spoke> star) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> after(star.size());
  for (std::size_t i = 0; i < star.size(); ++i) after[i] = {star[i].next, star[i].prev};
  std::sort(after.begin(), after.end());
  std::uint32_t at = after.front().first;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (i > 0 && after[i].first == after[i - 1].first) return false;
    const auto next = std::lower_bound(after.begin(), after.end(), std::pair{at, std::uint32_t{0}});
    if (next == after.end() || next->first != at) return false;
    at = next->second;
    if (at == after.front().first) return i + 1 == after.size();
  }
  return false;
}

/// Whether the triangles round a vertex are one closed fan, in which every edge has two.
inline bool is_one_fan(std::span<const Spoke> star) {
  constexpr std::size_t kFew = 24;
  if (star.size() < 3) return false;
  if (star.size() > kFew) return is_one_large_fan(star);
  std::size_t at = 0, steps = 0;
  do {
    const std::uint32_t wanted = star[at].prev;
    std::size_t found = star.size();
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (star[i].next != wanted) continue;
      if (found != star.size()) return false;  // an edge of more than two triangles
      found = i;
    }
    if (found == star.size()) return false;
    at = found;
    ++steps;
  } while (at != 0 && steps <= star.size());
  return steps == star.size();
}

/// Whether the star, one fan, is a graph over the plane across one of the directions that it faces:
/// its triangles, seen against the direction, run counter-clockwise and once round the vertex.
/// @param directions  of a face, as set_axis returns them
/// @param point       of a vertex
template <class Directions, class Point>
bool is_graph(std::span<const Spoke> star, const Vec3& at, const Directions& directions,
              const Point& point) {
  unsigned mask = 0x3F;
  for (const Spoke& s : star) mask &= directions(s.face);
  if (mask == 0) return false;
  int bit = 0;
  while (((mask >> static_cast<unsigned>(bit)) & 1U) == 0) ++bit;
  const int axis = bit / 2;
  int x = (axis + 1) % 3, y = (axis + 2) % 3;
  if (bit % 2 == 1) std::swap(x, y);
  const auto upper = [&](std::uint32_t w) {
    const Vec3& p = point(w);
    return p[y] != at[y] ? p[y] > at[y] : p[x] > at[x];
  };
  int turns = 0;
  for (const Spoke& s : star) turns += static_cast<int>(!upper(s.next) && upper(s.prev));
  return turns == 1;
}

}  // namespace kaboum::verify
