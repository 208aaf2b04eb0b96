// Quickhull (Barber, Dobkin, Huhdanpaa 1996) on exact orientation tests.
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cmath>

namespace kaboum::geom {

bool HullBuilder::find_simplex(std::array<std::uint32_t, 4>& corner) const {
  const auto n = static_cast<std::uint32_t>(points_.size());
  if (n < 4) return false;
  // Far apart where rounding allows; the exact tests only reject.
  int axis = 0;
  extent_.maxCoeff(&axis);
  std::uint32_t a = 0, b = 0;
  for (std::uint32_t i = 1; i < n; ++i) {
    if (points_[i][axis] < points_[a][axis]) a = i;
    if (points_[i][axis] > points_[b][axis]) b = i;
  }
  if (points_[a] == points_[b]) return false;
  const Vec3 ab = points_[b] - points_[a];
  const auto pick = [&](const auto& measure, const auto& good) {
    std::uint32_t best = 0;
    double most = -1;
    for (std::uint32_t i = 0; i < n; ++i) {
      const double m = measure(points_[i]);
      if (m > most) {
        most = m;
        best = i;
      }
    }
    if (good(best)) return best;
    for (std::uint32_t i = 0; i < n; ++i)
      if (good(i)) return i;
    return kNone;
  };
  const std::uint32_t c =
      pick([&](const Vec3& p) { return ab.cross(p - points_[a]).squaredNorm(); },
           [&](std::uint32_t i) { return !is_degenerate(points_[a], points_[b], points_[i]); });
  if (c == kNone) return false;
  const Vec3 normal = ab.cross(points_[c] - points_[a]);
  const std::uint32_t d =
      pick([&](const Vec3& p) { return std::abs(normal.dot(p - points_[a])); },
           [&](std::uint32_t i) {
             return orient3d(points_[a], points_[b], points_[c], points_[i]) != Sign::Zero;
           });
  if (d == kNone) return false;
  corner = {a, b, c, d};
  if (orient3d(points_[a], points_[b], points_[c], points_[d]) == Sign::Positive)
    std::swap(corner[1], corner[2]);
  return true;
}

std::uint32_t HullBuilder::add_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  Facet f{};
  f.v = {a, b, c};
  const Vec3 u = points_[b] - points_[a], w = points_[c] - points_[a];
  const double m1 = u.y() * w.z(), m2 = u.z() * w.y(), m3 = u.z() * w.x(), m4 = u.x() * w.z(),
               m5 = u.x() * w.y(), m6 = u.y() * w.x();
  f.normal = Vec3(m1 - m2, m3 - m4, m5 - m6);
  // The filter of orient3d with the set's extent in place of the point's offset.
  const double permanent = extent_.x() * (std::abs(m1) + std::abs(m2)) +
                           extent_.y() * (std::abs(m3) + std::abs(m4)) +
                           extent_.z() * (std::abs(m5) + std::abs(m6));
  f.bound = permanent > 1e-200 && permanent < 1e300 ? 1.1e-15 * permanent
                                                    : std::numeric_limits<double>::infinity();
  f.first = f.farthest = kNone;
  f.alive = true;
  facets_.push_back(f);
  return static_cast<std::uint32_t>(facets_.size() - 1);
}

double HullBuilder::above(const Facet& f, const Vec3& p) const {
  const Vec3 d = p - points_[f.v[0]];
  const double det = d.x() * f.normal.x() + d.y() * f.normal.y() + d.z() * f.normal.z();
  if (det > f.bound) return det;
  if (det < -f.bound) return 0;
  if (orient3d(points_[f.v[0]], points_[f.v[1]], points_[f.v[2]], p) != Sign::Positive) return 0;
  return std::max(det, std::numeric_limits<double>::min());
}

void HullBuilder::assign(std::uint32_t point, std::uint32_t facet, double height) {
  Facet& f = facets_[facet];
  if (f.first == kNone || height > f.height) {
    f.height = height;
    f.farthest = point;
  }
  next_[point] = f.first;
  f.first = point;
}

void HullBuilder::add_point(std::uint32_t start) {
  const std::uint32_t apex = facets_[start].farthest;
  const Vec3& p = points_[apex];
  ++mark_;
  visible_.assign(1, start);
  facets_[start].mark = mark_;
  horizon_.clear();
  for (std::size_t i = 0; i < visible_.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t g = facets_[visible_[i]].across[k];
      if (facets_[g].mark == mark_) continue;
      if (above(facets_[g], p) > 0) {
        facets_[g].mark = mark_;
        visible_.push_back(g);
      }
    }
  }
  for (const std::uint32_t f : visible_) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t g = facets_[f].across[k];
      if (facets_[g].mark == mark_) continue;
      std::uint32_t back = 0;
      while (facets_[g].across[back] != f || facets_[g].v[back] != facets_[f].v[(k + 1) % 3]) {
        ++back;
        ensure(back < 3, "hull: facets that do not know each other");
      }
      horizon_.push_back({facets_[f].v[k], facets_[f].v[(k + 1) % 3], g, back});
    }
  }
  fresh_.clear();
  for (const Ridge& r : horizon_) {
    const std::uint32_t f = add_facet(r.from, r.to, apex);
    facets_[f].across[0] = r.outer;
    facets_[r.outer].across[r.outer_edge] = f;
    ensure(facet_from_[r.from] == kNone, "hull: the horizon touches itself");
    facet_from_[r.from] = f;
    fresh_.push_back(f);
  }
  for (std::size_t i = 0; i < horizon_.size(); ++i) {
    const std::uint32_t f = fresh_[i], g = facet_from_[horizon_[i].to];
    ensure(g != kNone, "hull: the horizon is not closed");
    facets_[f].across[1] = g;  // edge to → apex
    facets_[g].across[2] = f;  // edge apex → from
  }
  for (const Ridge& r : horizon_) facet_from_[r.from] = kNone;
  for (const std::uint32_t f : visible_) {
    facets_[f].alive = false;
    for (std::uint32_t q = facets_[f].first; q != kNone;) {
      const std::uint32_t following = next_[q];
      if (q != apex) {
        for (const std::uint32_t g : fresh_) {
          const double height = above(facets_[g], points_[q]);
          if (height > 0) {
            assign(q, g, height);
            break;
          }
        }
      }
      q = following;
    }
  }
  for (const std::uint32_t f : fresh_)
    if (facets_[f].first != kNone) stack_.push_back(f);
}

bool HullBuilder::build(std::span<const Vec3> points) {
  points_ = points;
  facets_.clear();
  triangles_.clear();
  vertices_.clear();
  stack_.clear();
  mark_ = 0;
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  if (points.empty()) return false;
  // One rounding up covers the rounding of the difference.
  extent_ = (box.max - box.min) * (1 + 1e-15);
  std::array<std::uint32_t, 4> s{};
  if (!find_simplex(s)) return false;
  next_.assign(points.size(), kNone);
  facet_from_.assign(points.size(), kNone);
  // The fourth corner is below (s0, s1, s2).
  add_facet(s[0], s[1], s[2]);
  add_facet(s[1], s[0], s[3]);
  add_facet(s[2], s[1], s[3]);
  add_facet(s[0], s[2], s[3]);
  facets_[0].across = {1, 2, 3};
  facets_[1].across = {0, 3, 2};
  facets_[2].across = {0, 1, 3};
  facets_[3].across = {0, 2, 1};
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    for (std::uint32_t f = 0; f < 4; ++f) {
      const double height = above(facets_[f], points[i]);
      if (height > 0) {
        assign(i, f, height);
        break;
      }
    }
  }
  for (std::uint32_t f = 4; f-- > 0;)
    if (facets_[f].first != kNone) stack_.push_back(f);
  while (!stack_.empty()) {
    const std::uint32_t f = stack_.back();
    stack_.pop_back();
    if (facets_[f].alive && facets_[f].first != kNone) add_point(f);
  }
  std::vector<char> used(points.size(), 0);
  for (const Facet& f : facets_) {
    if (!f.alive) continue;
    triangles_.push_back(f.v);
    for (const std::uint32_t v : f.v) used[v] = 1;
  }
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (used[i] != 0) vertices_.push_back(i);
  return true;
}

Mesh HullBuilder::mesh() const {
  Mesh out;
  std::vector<std::uint32_t> number(points_.size());
  out.vertices.reserve(vertices_.size());
  for (const std::uint32_t v : vertices_) {
    number[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(points_[v]);
  }
  out.triangles.reserve(triangles_.size());
  for (const Triangle& t : triangles_)
    out.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return out;
}

std::optional<Mesh> convex_hull(std::span<const Vec3> points) {
  HullBuilder builder;
  if (!builder.build(points)) return std::nullopt;
  return builder.mesh();
}

}  // namespace kaboum::geom
