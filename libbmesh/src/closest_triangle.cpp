// Distances to triangles that are looked for across edges first, and then in a hierarchy.
#include "closest_triangle.h"

#include <kaboum/geom/topology.h>

#include <array>
#include <limits>

namespace kaboum::bmesh {

ClosestTriangle::ClosestTriangle(const geom::Mesh& mesh, bool keeps_hierarchy)
    : mesh_(mesh), bvh_(std::make_shared<const geom::Bvh>(mesh)) {
  order_.assign(bvh_->order().begin(), bvh_->order().end());
  wide_ = geom::WideBvh(mesh, *bvh_);
  if (!keeps_hierarchy) bvh_.reset();
  triangles_.reserve(mesh.triangles.size());
  for (const std::uint32_t i : order_) triangles_.push_back(mesh.triangles[i]);
  find_neighbours();
}

/// Places of the triangles across edges that two have.
void ClosestTriangle::find_neighbours() {
  std::vector<std::uint32_t> place(triangles_.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[triangle(i)] = i;
  across_.resize(triangles_.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) across_[i].fill(i);
  const std::vector<geom::EdgeUse> uses = geom::edge_uses(mesh_);
  geom::for_each_edge(uses, [&](std::span<const geom::EdgeUse> e) {
    if (e.size() != 2) return;
    across_[place[e[0].triangle]][e[0].corner] = place[e[1].triangle];
    across_[place[e[1].triangle]][e[1].corner] = place[e[0].triangle];
  });
}

ClosestTriangle::Found ClosestTriangle::walk(const Vec3& p, std::uint32_t place, double enough,
                                             double& squared) const {
  constexpr int kMostSteps = 12;
  Found best{place, std::numeric_limits<double>::infinity()};
  for (std::uint32_t at = place, from = place, i = 0; i <= kMostSteps; ++i) {
    const auto [a, b, c] = corners(at);
    const geom::ClosestPoint closest = geom::closest_and_beyond(p, a, b, c);
    const double d = (p - closest.point).squaredNorm();
    if (i == 0) squared = d;
    if (d > best.squared) break;
    best = {at, d};
    if (closest.beyond < 0 || !(d > enough)) break;
    const std::uint32_t next = across_[at][static_cast<std::size_t>(closest.beyond)];
    if (next == at || next == from) break;
    from = at;
    at = next;
  }
  return best;
}

double ClosestTriangle::squared(const Vec3& p, std::uint32_t& hint, double enough,
                                std::uint64_t* steps, const Vicinity* vicinity) const {
  if (hint >= triangles_.size()) hint = 0;
  double best = 0;
  Found near = walk(p, hint, enough, best);
  if (enough > 0 && !(near.squared > enough)) {
    hint = near.place;
    return near.squared;
  }
  // The walk only says how near the nearest is at most: which of several that are equally near is
  // found does not depend on it.
  float cutoff = wide_.frame().cutoff(near.squared);
  const auto done = [&] { return !(best > enough); };
  const auto visit = [&](std::uint32_t place) {
    const double d = squared_distance(p, corners(place));
    if (d >= best) return;
    best = d;
    hint = place;
    if (!(d < near.squared)) return;
    near = {place, d};
    cutoff = wide_.frame().cutoff(d);
  };
  const std::uint64_t visited = vicinity != nullptr && vicinity->holds(p, near.squared)
                                    ? wide_.visit_near(*vicinity, p, cutoff, done, visit)
                                    : wide_.visit_near(p, cutoff, done, visit);
  if (steps != nullptr) *steps += kNode * visited;
  if (near.squared < best) {  // far from all, single precision may have passed it over
    hint = near.place;
    best = near.squared;
  }
  return best;
}

}  // namespace kaboum::bmesh
