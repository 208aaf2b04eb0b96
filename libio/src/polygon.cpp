// Polygon splitting by ear clipping (Meisters 1975; the test of reflex corners only: Held 2001,
// "FIST"), with exact predicates.

#include "polygon.h"

#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <cmath>

namespace kaboum::io {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// Newell's normal, scaled so that it cannot overflow. Rounded: it only selects the projection.
geom::Vec3 newell_normal(std::span<const geom::Vec3> corners) {
  double largest = 0;
  for (const geom::Vec3& p : corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  if (largest == 0) return geom::Vec3::Zero();
  const geom::Vec3 origin = corners[0] / largest;
  geom::Vec3 normal = geom::Vec3::Zero();
  geom::Vec3 previous = corners.back() / largest - origin;
  for (const geom::Vec3& p : corners) {
    const geom::Vec3 current = p / largest - origin;
    normal += previous.cross(current);
    previous = current;
  }
  return normal;
}

}  // namespace

double bend_of(std::span<const geom::Vec3> corners) {
  // The first three corners that span a plane; every other one is on it, or the polygon is bent.
  const std::size_t n = corners.size();
  for (int k = 0; k < 3; ++k)  // most often
    if (std::all_of(corners.begin(), corners.end(),
                    [&](const geom::Vec3& p) { return p[k] == corners[0][k]; }))
      return 0;
  double largest = 0;
  for (const geom::Vec3& p : corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  std::size_t b = 1, c = 0;
  while (b < n && corners[b] == corners[0]) ++b;
  const auto collinear = [&](const geom::Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      if (geom::orient2d(corners[0][u], corners[0][v], corners[b][u], corners[b][v], p[u], p[v]) !=
          geom::Sign::Zero)
        return false;
    }
    return true;
  };
  for (c = b + 1; c < n && collinear(corners[c]); ++c) {
  }
  bool bent = false;
  for (std::size_t d = c + 1; d < n && !bent; ++d)
    bent = geom::orient3d(corners[0], corners[b], corners[c], corners[d]) != geom::Sign::Zero;
  if (!bent) return 0;
  const geom::Vec3 normal = newell_normal(corners).stableNormalized();
  double low = 0, high = 0;
  for (const geom::Vec3& p : corners) {
    const double height = normal.dot(p / largest - corners[0] / largest);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  // A normal of length 1 but for some roundings, and a dozen of them in each height.
  constexpr double kRoundings = 64 * 0x1p-53;
  return ((high - low) * (1 + kRoundings) + kRoundings) * largest;
}

bool PolygonSplitter::split(std::span<const geom::Vec3> corners,
                            std::vector<geom::Triangle>& triangles) {
  triangles.clear();
  const bool projected = project(corners);
  if (ring_.size() < 3) return true;
  if (ring_.size() == 3) {
    triangles.push_back(indices(0, 1, 2));
    return true;
  }
  if (projected) {
    if (ring_.size() == 4 && split_quad(triangles)) return true;
    if (ring_.size() > 4 && is_convex()) {
      fan(triangles);
      return true;
    }
    if (ring_.size() > 4 && clip_ears(triangles)) return true;
  }
  triangles.clear();
  fan(triangles);
  return false;
}

/// Fills the ring. @return false when the polygon has no normal.
bool PolygonSplitter::project(std::span<const geom::Vec3> corners) {
  const geom::Vec3 normal = newell_normal(corners);
  int axis = 0;
  if (std::abs(normal.y()) > std::abs(normal[axis])) axis = 1;
  if (std::abs(normal.z()) > std::abs(normal[axis])) axis = 2;
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);

  ring_.clear();
  std::uint32_t last = kNone;  // index of the latest corner in the ring
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    if (last != kNone && corners[last] == corners[i]) continue;
    ring_.push_back({corners[i][u], corners[i][v], i, 0, 0, true, false});
    last = i;
  }
  while (ring_.size() > 1 && corners[ring_.back().index] == corners[ring_.front().index])
    ring_.pop_back();
  const auto n = static_cast<std::uint32_t>(ring_.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    ring_[i].prev = (i + n - 1) % n;
    ring_[i].next = (i + 1) % n;
  }
  return normal[axis] != 0 && std::isfinite(normal[axis]);
}

int PolygonSplitter::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const Corner &p = ring_[a], &q = ring_[b], &r = ring_[c];
  return static_cast<int>(geom::orient2d(p.x, p.y, q.x, q.y, r.x, r.y));
}

bool PolygonSplitter::same_place(std::uint32_t a, std::uint32_t b) const {
  return ring_[a].x == ring_[b].x && ring_[a].y == ring_[b].y;
}

int PolygonSplitter::corner_turn(std::uint32_t i) const {
  return turn(ring_[i].prev, i, ring_[i].next);
}

geom::Triangle PolygonSplitter::indices(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return {ring_[a].index, ring_[b].index, ring_[c].index};
}

void PolygonSplitter::fan(std::vector<geom::Triangle>& triangles) const {
  for (std::uint32_t i = 1; i + 1 < ring_.size(); ++i) triangles.push_back(indices(0, i, i + 1));
}

/// Strictly convex everywhere, and running around once only: a locally convex polygon that winds
/// around k times has k lexicographically lowest corners.
bool PolygonSplitter::is_convex() const {
  int lowest = 0;
  for (std::uint32_t i = 0; i < ring_.size(); ++i) {
    if (corner_turn(i) <= 0) return false;
    const auto below = [this](std::uint32_t a, std::uint32_t b) {
      return ring_[a].x < ring_[b].x || (ring_[a].x == ring_[b].x && ring_[a].y < ring_[b].y);
    };
    if (below(i, ring_[i].prev) && below(i, ring_[i].next)) ++lowest;
  }
  return lowest == 1;
}

/// The first of the two diagonals that gives two triangles with area, or else one with area.
bool PolygonSplitter::split_quad(std::vector<geom::Triangle>& triangles) const {
  for (const int area_needed : {2, 1}) {
    for (const std::uint32_t i : {0U, 1U}) {
      const int s = turn(i, i + 1, i + 2);
      const int t = turn(i, i + 2, (i + 3) % 4);
      if (s < 0 || t < 0 || s + t < area_needed) continue;
      triangles.push_back(indices(i, i + 1, i + 2));
      triangles.push_back(indices(i, i + 2, (i + 3) % 4));
      return true;
    }
  }
  return false;
}

std::uint32_t PolygonSplitter::Grid::column(double at) const {
  if (columns == 1) return 0;
  return static_cast<std::uint32_t>(std::clamp((at - x) * per_x, 0.0, columns - 1.0));
}

std::uint32_t PolygonSplitter::Grid::row(double at) const {
  if (rows == 1) return 0;
  return static_cast<std::uint32_t>(std::clamp((at - y) * per_y, 0.0, rows - 1.0));
}

/// Of about as many cells as there are corners.
void PolygonSplitter::make_grid() {
  double low_x = ring_[0].x, low_y = ring_[0].y, high_x = low_x, high_y = low_y;
  for (const Corner& c : ring_) {
    low_x = std::min(low_x, c.x);
    low_y = std::min(low_y, c.y);
    high_x = std::max(high_x, c.x);
    high_y = std::max(high_y, c.y);
  }
  const double width = high_x - low_x, height = high_y - low_y;
  const auto n = static_cast<double>(ring_.size());
  const double aspect = width / height;
  double columns = std::clamp(std::sqrt(n * aspect), 1.0, n);
  // Where that is no number, all are in one cell; so where cells per length are none.
  if (!std::isfinite(columns)) columns = 1;
  double rows = std::clamp(n / columns, 1.0, n);
  double per_x = columns / width, per_y = rows / height;
  if (!std::isfinite(per_x) || !std::isfinite(per_y)) per_x = per_y = columns = rows = 1;
  if (!std::isfinite(width) || !std::isfinite(height)) columns = rows = 1;
  grid_.x = low_x;
  grid_.y = low_y;
  grid_.per_x = per_x;
  grid_.per_y = per_y;
  grid_.columns = static_cast<std::uint32_t>(columns);
  grid_.rows = static_cast<std::uint32_t>(rows);
  grid_.next.assign(ring_.size(), kNone);
  grid_.first.assign(std::size_t{grid_.columns} * grid_.rows, kNone);
}

void PolygonSplitter::add_to_grid(std::uint32_t i) {
  std::uint32_t& first =
      grid_.first[std::size_t{grid_.row(ring_[i].y)} * grid_.columns + grid_.column(ring_[i].x)];
  grid_.next[i] = first;
  first = i;
}

bool PolygonSplitter::clip_ears(std::vector<geom::Triangle>& triangles) {
  auto left = static_cast<std::uint32_t>(ring_.size());
  make_grid();
  spend(left);
  for (std::uint32_t i = 0; i < left; ++i) {
    ring_[i].reflex = corner_turn(i) <= 0;
    ring_[i].listed = ring_[i].reflex;
    if (ring_[i].reflex) add_to_grid(i);
  }
  std::uint32_t at = 0;
  for (; left > 3; --left) {
    const std::uint32_t ear = find_ear(at, left);
    if (ear == kNone) return false;
    const std::uint32_t prev = ring_[ear].prev, next = ring_[ear].next;
    triangles.push_back(indices(prev, ear, next));
    ring_[prev].next = next;
    ring_[next].prev = prev;
    ring_[ear].reflex = false;
    update_reflex(prev);
    update_reflex(next);
    // Going on behind the next corner spreads the ears and avoids a fan of slivers.
    at = ring_[next].next;
  }
  const std::uint32_t prev = ring_[at].prev, next = ring_[at].next;
  if (turn(prev, at, next) < 0) return false;
  triangles.push_back(indices(prev, at, next));
  return true;
}

/// An ear with area, from `start` on; else a corner without area; else kNone.
std::uint32_t PolygonSplitter::find_ear(std::uint32_t start, std::uint32_t left) {
  std::uint32_t flat = kNone;
  std::uint32_t i = start;
  for (std::uint32_t k = 0; k < left; ++k, i = ring_[i].next) {
    if (budget_ == 0) return kNone;
    spend(1);
    if (same_place(ring_[i].prev, ring_[i].next)) return i;  // a spike: nothing is lost
    if (ring_[i].reflex) {
      if (flat == kNone && corner_turn(i) == 0) flat = i;
    } else if (is_ear(i)) {
      return i;
    }
  }
  return flat;
}

/// No other corner lies in the closed triangle that a strictly convex corner cuts off. Corners at
/// the same place as one of the triangle's do not count: they are the ends of bridges.
bool PolygonSplitter::is_ear(std::uint32_t i) {
  const std::uint32_t p = ring_[i].prev, n = ring_[i].next;
  const auto [min_x, max_x] = std::minmax({ring_[p].x, ring_[i].x, ring_[n].x});
  const auto [min_y, max_y] = std::minmax({ring_[p].y, ring_[i].y, ring_[n].y});
  const std::uint32_t first_column = grid_.column(min_x), last_column = grid_.column(max_x);
  for (std::uint32_t row = grid_.row(min_y); row <= grid_.row(max_y); ++row) {
    for (std::uint32_t column = first_column; column <= last_column; ++column) {
      std::uint64_t steps = 1;
      bool holds = false;
      std::uint32_t* link = &grid_.first[std::size_t{row} * grid_.columns + column];
      while (*link != kNone && !holds) {
        const std::uint32_t r = *link;
        Corner& c = ring_[r];
        ++steps;
        if (!c.reflex) {  // no longer
          c.listed = false;
          *link = grid_.next[r];
          continue;
        }
        link = &grid_.next[r];
        if (c.x < min_x || c.x > max_x || c.y < min_y || c.y > max_y) continue;
        if (same_place(r, p) || same_place(r, i) || same_place(r, n)) continue;
        steps += 3;
        holds = turn(p, i, r) >= 0 && turn(i, n, r) >= 0 && turn(n, p, r) >= 0;
      }
      spend(steps);
      if (holds || budget_ == 0) return false;
    }
  }
  return true;
}

void PolygonSplitter::update_reflex(std::uint32_t i) {
  const bool reflex = corner_turn(i) <= 0;
  // Only non-simple polygons have corners that become reflex.
  if (reflex && !ring_[i].listed) {
    add_to_grid(i);
    ring_[i].listed = true;
  }
  ring_[i].reflex = reflex;
}

}  // namespace kaboum::io
