// Incremental Delaunay tetrahedra [bowyer1981], with exact predicates and no perturbation.
#include "delaunay.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/in_sphere.h>

#include <algorithm>
#include <bit>
#include <utility>

namespace kaboum::wrap {
namespace {

using geom::Sign;

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

std::uint64_t key_of(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32U) | to;
}

}  // namespace

Delaunay::Delaunay(const geom::Box3& box) {
  for (unsigned k = 0; k < 8; ++k)
    points_.emplace_back((k & 1U) != 0 ? box.max.x() : box.min.x(),
                         (k & 2U) != 0 ? box.max.y() : box.min.y(),
                         (k & 4U) != 0 ? box.max.z() : box.min.z());
  at_.assign(8, 0);
  // Four corners of the box, cut off from the tetrahedron in the middle.
  constexpr std::array<std::array<std::uint32_t, 4>, 5> kFive{
      {{0, 3, 5, 6}, {1, 0, 5, 3}, {2, 0, 3, 6}, {4, 0, 6, 5}, {7, 3, 6, 5}}};
  for (const auto& corners : kFive) cells_.push_back({corners, {kNone, kNone, kNone, kNone}});
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    auto& v = cells_[c].vertex;
    if (geom::orient3d(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]) !=
        Sign::Positive)
      std::swap(v[2], v[3]);
    ensure(geom::orient3d(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]) ==
               Sign::Positive,
           "the box of a wrap has no volume");
    for (const std::uint32_t w : v) at_[w] = c;
  }
  const auto across = [&](std::uint32_t c, std::uint32_t i) {
    for (std::uint32_t d = 0; d < cells_.size(); ++d) {
      if (d == c) continue;
      int common = 0;
      for (std::uint32_t k = 0; k < 4; ++k)
        common += k != i && cells_[d].has(cells_[c].vertex[k]) ? 1 : 0;
      if (common == 3) return d;
    }
    return kNone;
  };
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    for (std::uint32_t i = 0; i < 4; ++i) cells_[c].next[i] = across(c, i);
  mark_.assign(cells_.size(), 0);
}

bool Delaunay::conflicts(std::uint32_t c, const Vec3& p) const {
  const auto& [a, b, d, e] = cells_[c].vertex;
  return geom::in_sphere(points_[a], points_[b], points_[d], points_[e], p) == Sign::Positive;
}

std::uint32_t Delaunay::locate(const Vec3& p, std::uint32_t from) const {
  // A walk through facets that hide the point. It cannot go round for ever: the tetrahedra in front
  // of others, seen from a point, are ordered in a Delaunay triangulation.
  std::uint32_t c = from;
  while (true) {
    const Cell& cell = cells_[c];
    std::uint32_t over = 4;
    for (std::uint32_t i = 0; i < 4 && over == 4; ++i) {
      const auto& f = kFacet[i];
      if (geom::orient3d(points_[cell.vertex[f[0]]], points_[cell.vertex[f[1]]],
                         points_[cell.vertex[f[2]]], p) == Sign::Positive)
        over = i;
    }
    if (over == 4) return c;
    c = cell.next[over];
    if (c == kNone) return kNone;
  }
}

void Delaunay::find_hole(const Vec3& p, std::uint32_t start) {
  hole_.clear();
  rim_.clear();
  round_ += 2;
  hole_.push_back(start);
  mark_[start] = round_ + 1;
  for (std::size_t k = 0; k < hole_.size(); ++k) {
    const std::uint32_t c = hole_[k];
    const Cell& cell = cells_[c];
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t d = cell.next[i];
      if (d != kNone && mark_[d] < round_) {
        const bool in = conflicts(d, p);
        mark_[d] = round_ + (in ? 1 : 0);
        if (in) hole_.push_back(d);
      }
      if (d != kNone && mark_[d] == round_ + 1) continue;
      const auto& f = kFacet[i];
      rim_.push_back({{cell.vertex[f[0]], cell.vertex[f[1]], cell.vertex[f[2]]}, d, c});
    }
  }
}

std::uint32_t Delaunay::new_cell() {
  if (!free_.empty()) {
    const std::uint32_t c = free_.back();
    free_.pop_back();
    return c;
  }
  cells_.emplace_back();
  mark_.push_back(0);
  return static_cast<std::uint32_t>(cells_.size() - 1);
}

std::uint32_t Delaunay::insert(const Vec3& p, std::uint32_t near, double apart) {
  made_.clear();
  if (!conflicts(near, p)) {
    near = locate(p, near);
    if (near == kNone) return kNone;
    if (!conflicts(near, p)) return kNone;  // a vertex
  }
  find_hole(p, near);
  for (const Facet& f : rim_)
    for (const std::uint32_t v : f.corner)
      if ((points_[v] - p).squaredNorm() < apart * apart) return kNone;
  // On the box itself, or outside of it, p hides facets of the hole from itself.
  for (const Facet& f : rim_)
    if (f.beyond == kNone && geom::orient3d(points_[f.corner[0]], points_[f.corner[1]],
                                            points_[f.corner[2]], p) != Sign::Negative)
      return kNone;
  const auto v = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  at_.push_back(kNone);
  for (Facet& f : rim_) {
    const std::uint32_t hidden = f.cell;
    f.cell = new_cell();
    cells_[f.cell] = {{v, f.corner[0], f.corner[1], f.corner[2]}, {f.beyond, kNone, kNone, kNone}};
    if (f.beyond != kNone) {
      auto& next = cells_[f.beyond].next;
      std::size_t side = 0;  // where two tetrahedra meet, they meet in one facet
      while (next[side] != hidden) ++side;
      next[side] = f.cell;
    }
    for (const std::uint32_t w : cells_[f.cell].vertex) at_[w] = f.cell;
    made_.push_back(f.cell);
  }
  join_made();
  for (const std::uint32_t c : hole_) {
    cells_[c].vertex[0] = kNone;
    free_.push_back(c);
  }
  return v;
}

void Delaunay::join_made() {
  const std::size_t size = std::bit_ceil(6 * made_.size());
  table_.assign(size, {kEmpty, 0, 0});
  const auto slot = [&](std::uint64_t key) -> Edge& {
    std::size_t at = (key * 0x9E3779B97F4A7C15U) >> 32U;
    while (table_[at & (size - 1)].key != kEmpty && table_[at & (size - 1)].key != key) ++at;
    return table_[at & (size - 1)];
  };
  for (const std::uint32_t c : made_) {
    const auto& v = cells_[c].vertex;
    for (std::uint32_t i = 1; i < 4; ++i) {
      const std::uint32_t from = v[i == 3 ? 1 : i + 1], to = v[i == 1 ? 3 : i - 1];
      Edge& other = slot(key_of(to, from));
      if (other.key != kEmpty) {
        cells_[c].next[i] = other.cell;
        cells_[other.cell].next[other.side] = c;
      } else {
        slot(key_of(from, to)) = {key_of(from, to), c, i};
      }
    }
  }
}

std::uint32_t Delaunay::split(std::uint32_t from, std::uint32_t to, const Vec3& p,
                              std::span<const std::uint32_t> ring,
                              std::vector<std::uint32_t>& made) {
  const auto place = [&](std::uint32_t c, std::uint32_t v) {
    const auto& corners = cells_[c].vertex;
    return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  };
  for (const std::uint32_t c : ring) {
    for (const std::uint32_t end : {from, to}) {
      std::array<Vec3, 4> q;
      for (std::size_t k = 0; k < 4; ++k)
        q[k] = cells_[c].vertex[k] == end ? p : points_[cells_[c].vertex[k]];
      if (geom::orient3d(q[0], q[1], q[2], q[3]) != Sign::Positive) return kNone;
    }
  }
  const auto v = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  at_.push_back(ring.front());
  made.clear();
  for (std::size_t k = 0; k < ring.size(); ++k) made.push_back(new_cell());
  const auto other_of = [&](std::uint32_t c) {
    if (c == kNone) return kNone;
    return made[static_cast<std::size_t>(std::find(ring.begin(), ring.end(), c) - ring.begin())];
  };
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const std::uint32_t c = ring[k], d = made[k];
    const std::size_t at_from = place(c, from), at_to = place(c, to);
    cells_[d] = cells_[c];
    cells_[d].vertex[at_from] = v;
    cells_[c].vertex[at_to] = v;
    for (std::size_t i = 0; i < 4; ++i)
      if (i != at_from && i != at_to) cells_[d].next[i] = other_of(cells_[c].next[i]);
    const std::uint32_t beyond = cells_[c].next[at_from];  // across the facet opposite `from`
    if (beyond != kNone) {
      auto& next = cells_[beyond].next;
      *std::find(next.begin(), next.end(), c) = d;
    }
    cells_[d].next[at_to] = c;
    cells_[c].next[at_from] = d;
  }
  at_[from] = ring.front();
  at_[to] = made.front();
  for (std::size_t k = 0; k < ring.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) at_[cells_[made[k]].vertex[i]] = made[k];
  return v;
}

void Delaunay::cells_round(std::uint32_t v, std::vector<std::uint32_t>& cells) const {
  cells.assign(1, at_[v]);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Cell& cell = cells_[cells[k]];
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t d = cell.next[i];
      if (cell.vertex[i] == v || d == kNone) continue;
      if (std::find(cells.begin(), cells.end(), d) == cells.end()) cells.push_back(d);
    }
  }
}

}  // namespace kaboum::wrap
