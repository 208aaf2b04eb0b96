// Outer parallel bodies of solids: what is not in them, by caps. docs/algorithms/sphere-covers.md.
#include "parallel_body.h"

#include <kaboum/base/parallel.h>
#include <kaboum/geom/closest_point.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace kaboum::bcd {
namespace {

using geom::Vec3;

/// More caps than about so many are not looked for: they are larger then.
constexpr double kMostCaps = 100'000;
constexpr int kMostCuts = 3000;  ///< of caps for one radius
constexpr double kSqrt3Up = 1.7320508076;
/// Lengths are bounded from above and below with this relative allowance for rounding.
constexpr double kRounding = 1e-11;

Vec3 octant(int k) {
  return {(k & 1) != 0 ? 1.0 : -1.0, (k & 2) != 0 ? 1.0 : -1.0, (k & 4) != 0 ? 1.0 : -1.0};
}

/// The direction of a way, of length 1; not finite where the way has no length.
Vec3 direction_of(const Vec3& way) { return way / way.norm(); }

}  // namespace

/// A cube of the octree.
struct ParallelBody::Cell {
  Vec3 center;
  int side = 0;  ///< 1: outside the solid, -1: inside, 0: not known
};

/// A cube as it is known: whether the boundary may be in it, its side and its distance.
struct ParallelBody::Look {
  bool open = false;            ///< the boundary may be in it
  int side = 0;                 ///< of the middle
  double lower = 0, upper = 0;  ///< its distance from the surface
  std::uint32_t triangle = 0;   ///< one that is no farther
};

ParallelBody::ParallelBody(const geom::DistanceQuery& surface, const geom::WindingNumber& winding,
                           double distance, double share)
    : surface_(surface), winding_(winding), distance_(distance), share_(share) {
  find_caps();
  geom::Mesh centers;
  centers.vertices.reserve(caps_.size());
  centers.triangles.reserve(caps_.size());
  for (std::uint32_t i = 0; i < caps_.size(); ++i) {
    centers.vertices.push_back(caps_[i].center);
    centers.triangles.push_back({i, i, i});
  }
  if (!caps_.empty()) tree_ = geom::Bvh(centers);
}

ParallelBody::SignedDistance ParallelBody::signed_distance(const Vec3& p) const {
  return signed_distance(p, surface_.nearest(p));
}

ParallelBody::SignedDistance ParallelBody::signed_distance(
    const Vec3& p, const geom::TriangleSearch::Nearest& near) const {
  const double lower = near.lower * (1 - kRounding), upper = near.upper * (1 + kRounding);
  const std::optional<int> winding = winding_(p);
  if (winding && *winding >= 1) return {-upper, -lower};
  return {winding ? lower : -0.0, upper};
}

ParallelBody::Around ParallelBody::look_around(const Vec3& c) const {
  const geom::TriangleSearch::Nearest near = surface_.nearest(c);
  const auto& [p, q, r] = surface_.corners(near.triangle);
  return {signed_distance(c, near), direction_of(geom::closest_point(c, p, q, r) - c)};
}

ParallelBody::Look ParallelBody::look_at(const Cell& cell, double h) const {
  const geom::TriangleSearch::Nearest near = surface_.nearest(cell.center);
  Look out;
  out.lower = near.lower * (1 - kRounding);
  out.upper = near.upper * (1 + kRounding);
  out.triangle = near.triangle;
  if (out.upper + h <= distance_ || out.lower - h > distance_) return out;
  out.side = cell.side;
  if (out.side == 0) {
    const std::optional<int> winding = winding_(cell.center);
    out.side = winding && *winding <= 0 ? 1 : -1;
  }
  out.open = out.side > 0 || h > distance_ + out.lower;
  return out;
}

/// The part of the ball round a cube that may be outside the body, a cap; nullopt: there is none.
std::optional<ParallelBody::Cap> ParallelBody::cap_of(const Cell& cell, const Look& look,
                                                      double h) const {
  if (look.side < 0 || !(look.upper > 0)) return Cap{cell.center, Vec3::UnitX(), -h};
  const auto& [p, q, r] = surface_.corners(look.triangle);
  const Vec3 from = cell.center - geom::closest_point(cell.center, p, q, r);
  const double height =
      (distance_ * distance_ - look.upper * look.upper - h * h) / (2 * look.upper) -
      kRounding * distance_;
  if (!(height < h)) return std::nullopt;
  return Cap{cell.center, from.normalized(), std::max(height, -h)};
}

void ParallelBody::find_caps() {
  const geom::Box3& box = surface_.box();
  const double size = (box.max - box.min).maxCoeff() + 2.2 * distance_;
  double area = 0;
  for (const auto& [a, b, c] : surface_.ordered()) area += 0.5 * (b - a).cross(c - a).norm();
  // About two cubes for each square of their size.
  const double least = std::max(share_ * distance_, kSqrt3Up * std::sqrt(0.5 * area / kMostCaps));
  half_ = least / kSqrt3Up;
  int cuts = 0;
  for (; half_ < 0.5 * size; ++cuts) half_ *= 2;
  std::vector<Cell> cells{{box.center(), 0}};
  for (;; --cuts) {
    h_ = kSqrt3Up * half_;
    std::vector<Look> looks(cells.size());
    kaboum::parallel_for(std::size_t{0}, cells.size(),
                         [&](std::size_t i) { looks[i] = look_at(cells[i], h_); });
    std::vector<Cell> next;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!looks[i].open) continue;
      if (cuts == 0) {
        if (const std::optional<Cap> cap = cap_of(cells[i], looks[i], h_)) caps_.push_back(*cap);
        continue;
      }
      const int side = looks[i].lower > 0.5 * h_ ? looks[i].side : 0;
      for (int k = 0; k < 8; ++k) next.push_back({cells[i].center + 0.5 * half_ * octant(k), side});
    }
    if (cuts == 0) return;
    half_ *= 0.5;
    cells = std::move(next);
  }
}

namespace {

/// Distance of c from the points x with |x − center| ≤ h and normal · (x − center) ≥ height, or
/// less.
double distance_from_cap(const Vec3& center, const Vec3& normal, double height, double h,
                         const Vec3& c) {
  const Vec3 to = c - center;
  const double square = to.squaredNorm(), along = normal.dot(to);
  const double up = std::max(0.0, height - along);
  const double away = std::sqrt(std::max(0.0, square - along * along));
  const double width = height > 0 ? std::sqrt(std::max(0.0, h * h - height * height)) : h;
  const double aside = std::max(0.0, away - width);
  return std::max(std::sqrt(up * up + aside * aside), std::sqrt(square) - h);
}

/// The point that is as near to c as distance_from_cap says.
Vec3 nearest_of_cap(const Vec3& center, const Vec3& normal, double height, double h,
                    const Vec3& c) {
  const Vec3 to = c - center;
  const double along = normal.dot(to), width = std::sqrt(std::max(0.0, h * h - height * height));
  const Vec3 aside = to - along * normal;
  const double away = aside.norm();
  const double up = std::clamp(along, height, h);
  const double out = std::min(away, height > 0 ? width : h);
  return center + up * normal + (away > 0 ? out / away : 0) * aside;
}

}  // namespace

template <class Visit>
void ParallelBody::visit_near(const Vec3& c, const double& limit, const Visit& visit) const {
  if (caps_.empty()) return;
  const auto nodes = tree_.nodes();
  // Squares are compared, with room for rounding.
  const auto to_box = [&](const geom::Box3& box) {
    return (box.min - c).cwiseMax(c - box.max).cwiseMax(0.0).squaredNorm();
  };
  const auto cutoff = [&] { return (limit + h_) * (limit + h_) * (1 + kRounding); };
  std::array<std::pair<double, std::uint32_t>, geom::Bvh::kMaxDepth> stack;
  int size = 0;
  double most = cutoff();
  stack[size++] = {to_box(nodes[0].box), 0};
  while (size > 0) {
    const auto [square, index] = stack[--size];
    if (square >= most) continue;
    const geom::Bvh::Node& node = nodes[index];
    if (node.leaf()) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Cap& cap = caps_[tree_.order()[i]];
        visit(cap, distance_from_cap(cap.center, cap.normal, cap.height, h_, c));
      }
      most = cutoff();
      continue;
    }
    std::pair<double, std::uint32_t> near{to_box(nodes[index + 1].box), index + 1};
    std::pair<double, std::uint32_t> far{to_box(nodes[node.first].box), node.first};
    if (far.first < near.first) std::swap(near, far);
    if (far.first < most) stack[size++] = far;
    if (near.first < most) stack[size++] = near;
  }
}

/// Whether no radius about c is larger than that of the ball in the solid and the distance, but for
/// a share of it: there is a point beyond the nearest triangle that is not in the body.
/// @param along  of length 1, to the nearest point of the surface
bool ParallelBody::is_nearest_deciding(const Vec3& c, const Vec3& along, double s,
                                       double share) const {
  if (!(s < 0) || !along.allFinite()) return false;
  const double reach = distance_ * (1 + 0.5 * share * share) - s;
  return signed_distance(c + reach * along).lower > distance_;
}

double ParallelBody::radius_about(const Vec3& c) const { return room_about(c).radius; }

ParallelBody::Room ParallelBody::room_about(const Vec3& c) const {
  const Around around = look_around(c);
  const double s = around.signed_distance.upper;
  if (!(s < distance_)) return {};
  const double known = distance_ - s;
  double best = std::numeric_limits<double>::infinity();
  const Cap* nearest = nullptr;
  if (!caps_.empty() && !is_nearest_deciding(c, around.along, s, share_))
    visit_near(c, best, [&](const Cap& cap, double away) {
      if (!(away < best)) return;
      best = away;
      nearest = &cap;
    });
  if (nearest == nullptr) {  // it ends beyond the nearest point of the surface
    if (!around.along.allFinite()) return {known, std::nullopt};
    return {known, c + (s < 0 ? known : -known) * around.along};
  }
  const double radius = std::max(best * (1 - kRounding), known);
  const Vec3 along =
      direction_of(nearest_of_cap(nearest->center, nearest->normal, nearest->height, h_, c) - c);
  if (!along.allFinite()) return {radius, std::nullopt};
  return {radius, c + radius * along};
}

std::optional<Vec3> ParallelBody::boundary_near(const Vec3& c) const {
  double best = std::numeric_limits<double>::infinity();
  std::optional<Vec3> out;
  visit_near(c, best, [&](const Cap& cap, double away) {
    if (!(away < best)) return;
    best = away;
    out = cap.center + cap.height * cap.normal;
  });
  return out;
}

double ParallelBody::refined_radius_about(const Vec3& c, double share) const {
  const double known = radius_about(c);
  if (!(known > 0) || caps_.empty()) return known;
  const Around around = look_around(c);
  if (const double s = around.signed_distance.upper; is_nearest_deciding(c, around.along, s, share))
    return std::max(known, distance_ - s);
  struct Open {
    double away;
    Cell cell;
    double half;
    bool operator<(const Open& other) const { return away > other.away; }  // the nearest on top
  };
  std::priority_queue<Open> open;
  // Radii lose no more than this.
  double limit = known + h_ * h_ / distance_ + kRounding * known;
  const double most = limit;
  visit_near(c, limit, [&](const Cap& cap, double away) {
    if (away < most) open.push({away, {cap.center, 0}, half_});
  });
  for (int cuts = 0; !open.empty() && cuts < kMostCuts; ++cuts) {
    const Open now = open.top();
    if (kSqrt3Up * now.half <= share * distance_) break;
    open.pop();
    const double half = 0.5 * now.half, h = kSqrt3Up * half;
    for (int k = 0; k < 8; ++k) {
      const Cell cell{now.cell.center + half * octant(k), 0};
      const Look look = look_at(cell, h);
      if (!look.open) continue;
      if (const std::optional<Cap> cap = cap_of(cell, look, h))
        if (const double away = distance_from_cap(cap->center, cap->normal, cap->height, h, c);
            away < most)
          open.push({std::max(away, now.away), cell, half});
    }
  }
  const double found = open.empty() ? most : open.top().away;
  return std::max(known, found * (1 - kRounding));
}

}  // namespace kaboum::bcd
