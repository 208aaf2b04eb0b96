// Membership in a solid, exact, and conditions that whole pieces lie in it. The arguments are in
// docs/algorithms/distances.md, "Solids".
#include <kaboum/base/error.h>
#include <kaboum/distance/solid.h>
#include <kaboum/geom/convex_polytope.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "inflated.h"

namespace kaboum::distance {
namespace {

using geom::Box3;
using geom::kDistanceRounding;
using geom::Mesh;
using geom::Vec3;

/// Whether a plane certainly separates the convex hull of the corners from the triangle, with more
/// than `margin` between them; tried are the planes across the triangle's and the polygon's normal
/// and across their sides.
bool separated(std::span<const Vec3> corners, const std::array<Vec3, 3>& t, double margin) {
  const Vec3& origin = t[0];
  std::array<Vec3, 8> p;
  const std::size_t n = corners.size();
  double magnitude = 0;
  for (std::size_t i = 0; i < n; ++i) {
    p[i] = corners[i] - origin;
    magnitude = std::max(magnitude, p[i].cwiseAbs().maxCoeff());
  }
  const std::array<Vec3, 3> q{Vec3::Zero(), t[1] - origin, t[2] - origin};
  for (const Vec3& x : q) magnitude = std::max(magnitude, x.cwiseAbs().maxCoeff());
  const double least = margin + 2 * kDistanceRounding * magnitude;
  const auto separates = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    double low = direction.dot(p[0]), high = low;
    for (std::size_t i = 1; i < n; ++i) {
      const double at = direction.dot(p[i]);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const double x = direction.dot(q[1]), y = direction.dot(q[2]);
    const double gap = std::max(low - std::max({0.0, x, y}), std::min({0.0, x, y}) - high);
    return gap > least * length * (1 + kDistanceRounding);
  };
  const Vec3 normal = q[1].cross(q[2]);
  if (separates(normal)) return true;
  const Vec3 own = n > 2 ? Vec3((p[1] - p[0]).cross(p[2] - p[0])) : Vec3::Zero();
  if (separates(own)) return true;
  for (int j = 0; j < 3; ++j)
    if (separates(Vec3((q[(j + 1) % 3] - q[j]).cross(normal)))) return true;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 side = p[(i + 1) % n] - p[i];
    if (separates(Vec3(side.cross(own)))) return true;
    for (int j = 0; j < 3; ++j)
      if (separates(Vec3(side.cross(q[(j + 1) % 3] - q[j])))) return true;
  }
  return false;
}

/// Whether no point outside the solid is nearest to the edge: seen from outside, its triangles fold
/// inwards.
/// @param whole  per triangle: it is one of the mesh's, not a part with rounded corners.
bool is_hidden(const Mesh& mesh, std::span<const char> whole, std::span<const geom::EdgeUse> edge) {
  if (std::any_of(edge.begin(), edge.end(),
                  [&](const geom::EdgeUse& use) { return whole[use.triangle] == 0; }))
    return false;
  const Vec3 &lo = mesh.vertices[edge[0].lo], &hi = mesh.vertices[edge[0].hi];
  const auto across = [&](const geom::EdgeUse& e) -> const Vec3& {
    return mesh.vertices[mesh.triangles[e.triangle][(e.corner + 2) % 3]];
  };
  const auto side = [&](const geom::EdgeUse& s, const geom::EdgeUse& t) {
    return geom::orient3d(lo, hi, across(s), across(t));
  };
  if (edge.size() == 2 && edge[0].forward != edge[1].forward) {
    // Seen from the one that runs lo → hi, counter-clockwise from outside: the other is above, or
    // goes on in its plane.
    const std::size_t s = edge[0].forward ? 0 : 1;
    return side(edge[s], edge[1 - s]) != geom::Sign::Negative;
  }
  if (edge.size() <= 2) return false;
  // Triangles on both sides of each one's plane: no direction is away from all of them.
  return std::all_of(edge.begin(), edge.end(), [&](const geom::EdgeUse& s) {
    bool above = false, below = false;
    for (const geom::EdgeUse& t : edge) {
      above = above || side(s, t) == geom::Sign::Positive;
      below = below || side(s, t) == geom::Sign::Negative;
    }
    return above && below;
  });
}

/// Takes so much from radii that rounding moves no point of polytopes within the bodies out of
/// them.
/// @return the most that was taken [length]
double shrink(geom::ConvexSet& set) {
  double most = 0;
  for (geom::ConvexBody& body : set.bodies) {
    double largest = body.radius;
    for (const Vec3& p : body.core.vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    const double taken = std::min(body.radius, 0x1p-40 * body.radius + 0x1p-48 * largest);
    body.radius -= taken;
    most = std::max(most, taken);
  }
  return most;
}

/// Of subdivision: the finer, the fewer bodies there are, for as much work.
int level_for(std::size_t bodies) { return bodies <= 20 ? 4 : bodies <= 200 ? 3 : 2; }

}  // namespace

/// Whose points are asked for: one chain, or bodies.
struct Solid::Members {
  Mesh mesh;
  std::optional<geom::WindingNumber> winding;
  std::vector<geom::ConvexPolytope> bodies;
};

Solid::Solid(const Mesh& mesh)
    : members_(std::make_unique<Members>()), boundary_(solid_boundary(mesh)) {
  members_->mesh = mesh;
  members_->winding.emplace(members_->mesh);
  prepare();
}

Solid::Solid(const geom::ConvexSet& set) : members_(std::make_unique<Members>()), set_(set) {
  if (set.bodies.empty()) throw Error(ErrorCode::InvalidInput, "the empty set has no distance");
  if (const auto margin = geom::margin_of(set)) {
    margin_ = *margin;
  } else {
    require_convex(set);
    const double taken = shrink(set_);
    Inflated inflated = inflate(set_, level_for(set.bodies.size()));
    set_ = std::move(inflated.polytopes);
    defect_ = inflated.defect + taken;
  }
  boundary_ = union_boundary(set_);
  for (const geom::ConvexBody& body : set_.bodies) members_->bodies.emplace_back(body.core);
  prepare();
}

Solid::~Solid() = default;

void Solid::prepare() {
  bvh_ = geom::Bvh(boundary_.mesh);
  const Box3 box = geom::bounding_box(boundary_.mesh);
  magnitude_ = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  find_exposed();
}

void Solid::find_exposed() {
  const Mesh mesh = geom::weld(boundary_.mesh);
  exposed_.assign(mesh.triangles.size(), 0);
  std::vector<char> corner_exposed(mesh.vertices.size(), 0);
  geom::for_each_edge(geom::edge_uses(mesh), [&](std::span<const geom::EdgeUse> edge) {
    if (is_hidden(mesh, boundary_.whole, edge)) return;
    corner_exposed[edge[0].lo] = corner_exposed[edge[0].hi] = 1;
    for (const geom::EdgeUse& use : edge)
      exposed_[use.triangle] |= static_cast<std::uint8_t>(1U << use.corner);
  });
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    for (int k = 0; k < 3; ++k)
      if (corner_exposed[v[k]] != 0) exposed_[t] |= static_cast<std::uint8_t>(8U << k);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) exposed_[t] = 0x3f;
  }
}

std::optional<bool> Solid::contains(const Vec3& p, double free) const {
  if (members_->winding) {
    std::optional<int> w = (*members_->winding)(p);
    // On a fold: beside it, no farther than the boundary is.
    const double step = 0.3 * (free - boundary_.error);
    if (!w && step > 0x1p-50 * std::max(magnitude_, p.cwiseAbs().maxCoeff()))
      for (const Vec3& by : {Vec3(1, 0.31, 0.17), Vec3(-0.27, 1, 0.41), Vec3(0.37, -0.23, 1)})
        if (!w) w = (*members_->winding)(p + step * by);
    return w ? std::optional(*w >= 1) : std::nullopt;
  }
  return std::any_of(members_->bodies.begin(), members_->bodies.end(),
                     [&](const geom::ConvexPolytope& body) { return body.contains(p); });
}

double Solid::distance(const Vec3& p, double to_boundary) const {
  return contains(p, to_boundary) == std::optional(true) ? 0 : std::max(0.0, to_boundary - margin_);
}

bool Solid::covers_ball(const Vec3& center, double radius, double distance) const {
  return distance > radius * (1 + kDistanceRounding) + boundary_.error &&
         contains(center, distance) == std::optional(true);
}

bool Solid::covers(std::span<const Vec3> corners, double slack) const {
  Vec3 center = Vec3::Zero();
  double magnitude = magnitude_;
  for (const Vec3& p : corners) {
    center += p;
    magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  }
  center /= static_cast<double>(corners.size());
  // Corners move towards the centre, by no more than the slack with all rounding.
  const double rounding = 4 * kDistanceRounding * magnitude;
  slack -= rounding;
  if (!(slack > 0)) return false;
  double radius = 0;
  for (const Vec3& p : corners) radius = std::max(radius, (p - center).norm());
  const double shrink = radius > slack ? slack / radius * (1 - kDistanceRounding) : 1;
  std::array<Vec3, 8> shrunk;
  Box3 box;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    shrunk[i] = corners[i] + shrink * (center - corners[i]);
    box.extend(shrunk[i]);
  }
  const double margin = boundary_.error + rounding;
  box.min.array() -= margin;
  box.max.array() += margin;
  bool free = true;
  const auto overlaps = [&](const Box3& b) {
    return free && (box.min.array() <= b.max.array()).all() &&
           (b.min.array() <= box.max.array()).all();
  };
  bvh_.traverse(overlaps, [&](std::uint32_t t) {
    if (!free) return;
    const auto& [i, j, k] = boundary_.mesh.triangles[t];
    const std::array<Vec3, 3> triangle{boundary_.mesh.vertices[i], boundary_.mesh.vertices[j],
                                       boundary_.mesh.vertices[k]};
    free = separated({shrunk.data(), corners.size()}, triangle, margin);
  });
  return free && contains(center, margin) == std::optional(true);
}

bool Solid::near(const Vec3& p, double radius, std::size_t most,
                 std::vector<std::uint32_t>& triangles) const {
  triangles.clear();
  bool few = true;
  const double limit = radius * radius * (1 + kDistanceRounding);
  bvh_.traverse(
      [&](const Box3& box) {
        return few && (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm() <= limit;
      },
      [&](std::uint32_t t) {
        if (triangles.size() >= most) few = false;
        if (few) triangles.push_back(t);
      });
  return few;
}

Minimum solid_minimum(const Solid& a, const Solid& b) {
  Minimum m = minimum_distance(a.boundary().mesh, b.boundary().mesh);
  const double error = a.boundary().error + b.boundary().error;
  // Boundaries apart: every part of either lies in the other solid or outside it.
  if (m.lower > error) {
    bool unknown = false;
    const auto meets = [&](const Solid& inner, const Solid& outer) -> std::optional<Vec3> {
      const Mesh mesh = geom::weld(inner.boundary().mesh);
      std::uint32_t parts = 0;
      const std::vector<std::uint32_t> part = geom::components(mesh, false, &parts);
      std::vector<char> seen(parts, 0);
      for (std::size_t t = 0; t < part.size(); ++t) {
        if (seen[part[t]] != 0) continue;
        seen[part[t]] = 1;
        const Vec3& p = mesh.vertices[mesh.triangles[t][0]];
        const std::optional<bool> within = outer.contains(p, m.lower - inner.boundary().error);
        if (within == std::optional(true)) return p;
        unknown = unknown || !within;
      }
      return std::nullopt;
    };
    std::optional<Vec3> common = meets(a, b);
    if (!common) common = meets(b, a);
    if (common) {
      m.lower = m.upper = 0;
      m.on_a = m.on_b = *common;
      return m;
    }
    if (unknown) m.lower = 0;
  }
  const double margins = a.margin() + b.margin();
  // Where a boundary was cut and rounded, the true ones may be this much apart.
  m.lower = std::max(0.0, m.lower - error - margins - a.defect() - b.defect());
  m.upper = std::max(0.0, m.upper + error - margins);
  return m;
}

}  // namespace kaboum::distance
