// Moves, splits and contractions as sums of tetrahedra that the obstacle is clear of, with new
// triangles that meet no others.
#include "surface.h"

#include <kaboum/geom/float32.h>
#include <kaboum/geom/topology.h>

#include <algorithm>

namespace kaboum::wrap {

Surface::Surface(geom::Mesh mesh, const Obstacle& obstacle, bool float32)
    : points_(std::move(mesh.vertices)),
      triangles_(std::move(mesh.triangles)),
      stars_(points_.size()),
      obstacle_(obstacle),
      float32_(float32) {
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (const std::uint32_t v : triangles_[t]) stars_[v].push_back(t);
  build_crowd();
}

void Surface::build_crowd() {
  std::vector<char> in_use(triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) in_use[t] = gone(t) ? 0 : 1;
  crowd_.build(points_, triangles_, in_use);
}

namespace {

geom::Box3 box_of(const geom::NamedTriangle& t) {
  geom::Box3 box;
  for (const Vec3& p : t.at) box.extend(p);
  return box;
}

}  // namespace

bool Surface::apart(std::span<const Change> changes, std::span<const std::uint32_t> removed) {
  ++check_;
  mark_.resize(triangles_.size(), 0);
  for (const std::uint32_t t : removed) mark_[t] = check_;
  boxes_.clear();
  geom::Box3 all;
  for (const Change& c : changes) {
    if (c.triangle < mark_.size()) mark_[c.triangle] = check_;
    if (geom::is_degenerate(c.to.at[0], c.to.at[1], c.to.at[2])) return false;
    boxes_.push_back(box_of(c.to));
    all.extend(boxes_.back());
  }
  for (std::size_t i = 0; i < changes.size(); ++i)
    for (std::size_t k = i + 1; k < changes.size(); ++k)
      if (geom::meet_improperly(changes[i].to, changes[k].to)) return false;
  return crowd_.all_near(all, [&](std::uint32_t t) {
    if (mark_[t] == check_) return true;
    const geom::Triangle& c = triangles_[t];
    const geom::NamedTriangle other{c, {points_[c[0]], points_[c[1]], points_[c[2]]}};
    const geom::Box3 box = box_of(other);
    for (std::size_t i = 0; i < changes.size(); ++i)
      if (overlap(box, boxes_[i]) && geom::meet_improperly(changes[i].to, other)) return false;
    return true;
  });
}

void Surface::note(std::span<const Change> changes) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Change& c = changes[i];
    if (c.near == c.triangle) {
      crowd_.grow(c.triangle, boxes_[i]);
    } else {
      crowd_.add(c.triangle, c.near, boxes_[i]);
    }
  }
  if (crowd_.stale()) build_crowd();
}

void Surface::change(std::uint32_t t, std::uint32_t from, std::uint32_t to, const Vec3& p) {
  Change c{t, t, {triangles_[t], {}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = c.to.name[k];
    c.to.at[k] = v == from || v == to ? p : points_[v];
    if (v == from) c.to.name[k] = to;
  }
  changes_.push_back(c);
}

std::vector<std::uint32_t> Surface::neighbours(std::uint32_t v) const {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t t : stars_[v])
    for (const std::uint32_t w : triangles_[t])
      if (w != v) result.push_back(w);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

Vec3 Surface::representable(const Vec3& p) const { return float32_ ? geom::to_float32(p) : p; }

bool Surface::has(std::uint32_t t, std::uint32_t v) const {
  const geom::Triangle& c = triangles_[t];
  return c[0] == v || c[1] == v || c[2] == v;
}

void Surface::add_cone(std::uint32_t t, const Vec3& p, std::vector<Tetrahedron>& cones) const {
  const geom::Triangle& c = triangles_[t];
  cones.push_back({points_[c[0]], points_[c[1]], points_[c[2]], p});
}

void Surface::leave(std::uint32_t v, std::uint32_t t) {
  std::vector<std::uint32_t>& star = stars_[v];
  star.erase(std::find(star.begin(), star.end(), t));
}

bool Surface::move(std::uint32_t v, const Vec3& p) {
  if (!p.allFinite()) return false;
  cones_.clear();
  changes_.clear();
  for (const std::uint32_t t : stars_[v]) {
    add_cone(t, p, cones_);
    change(t, v, v, p);
  }
  if (!obstacle_.clear(cones_) || !apart(changes_, {})) return false;
  points_[v] = p;
  note(changes_);
  return true;
}

std::uint32_t Surface::split(std::uint32_t a, std::uint32_t b, const Vec3& p) {
  if (!p.allFinite()) return kNone;
  std::vector<std::uint32_t> at;
  cones_.clear();
  changes_.clear();
  const auto v = static_cast<std::uint32_t>(points_.size());
  for (const std::uint32_t t : stars_[a]) {
    if (!has(t, b)) continue;
    add_cone(t, p, cones_);
    change(t, b, v, p);
    change(t, a, v, p);
    changes_.back().triangle = static_cast<std::uint32_t>(triangles_.size() + at.size());
    at.push_back(t);
  }
  if (!obstacle_.clear(cones_) || !apart(changes_, {})) return kNone;
  points_.push_back(p);
  stars_.emplace_back();
  for (const std::uint32_t t : at) {
    // The one half keeps the triangle's place and corner a, the other is new and has b.
    geom::Triangle other = triangles_[t];
    std::replace(other.begin(), other.end(), a, v);
    std::replace(triangles_[t].begin(), triangles_[t].end(), b, v);
    const auto u = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(other);
    leave(b, t);
    for (const std::uint32_t w : other) stars_[w].push_back(u);
    stars_[v].push_back(t);
  }
  note(changes_);
  return v;
}

bool Surface::contract(std::uint32_t a, std::uint32_t b, const Vec3& p) {
  if (!p.allFinite()) return false;
  std::size_t common = 0;
  const std::vector<std::uint32_t> of_a = neighbours(a), of_b = neighbours(b);
  for (const std::uint32_t v : of_a)
    common += std::binary_search(of_b.begin(), of_b.end(), v) ? 1 : 0;
  std::vector<std::uint32_t> at;
  cones_.clear();
  changes_.clear();
  for (const std::uint32_t t : stars_[a]) {
    add_cone(t, p, cones_);
    if (has(t, b)) {
      at.push_back(t);
    } else {
      change(t, a, a, p);
    }
  }
  if (common != at.size() || at.size() != 2) return false;
  for (const std::uint32_t t : stars_[b]) {
    if (has(t, a)) continue;
    add_cone(t, p, cones_);
    change(t, b, a, p);
  }
  if (!obstacle_.clear(cones_) || !apart(changes_, at)) return false;
  for (const std::uint32_t t : at) {
    for (const std::uint32_t v : triangles_[t])
      if (v != b) leave(v, t);
    triangles_[t] = {kNone, kNone, kNone};
    crowd_.remove(t);
  }
  for (const std::uint32_t t : stars_[b]) {
    if (gone(t)) continue;
    std::replace(triangles_[t].begin(), triangles_[t].end(), b, a);
    stars_[a].push_back(t);
  }
  stars_[b].clear();
  points_[a] = p;
  note(changes_);
  return true;
}

geom::Mesh Surface::mesh() const {
  geom::Mesh result;
  std::vector<std::uint32_t> number(points_.size(), kNone);
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    if (stars_[v].empty()) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(points_[v]);
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (gone(t)) continue;
    const geom::Triangle& c = triangles_[t];
    result.triangles.push_back({number[c[0]], number[c[1]], number[c[2]]});
  }
  return result;
}

}  // namespace kaboum::wrap
