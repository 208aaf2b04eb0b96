// Brings the surface near to the input.
#include "fit.h"

#include <algorithm>
#include <array>

namespace kaboum::wrap {

bool Fit::approach(std::uint32_t v) {
  constexpr double kNear = 1.2;  // times the aim: not worth a step
  const Vec3 p = surface_.point(v);
  const Foot foot = obstacle_.foot(p, hint_[v]);
  hint_[v] = foot.triangle;
  if (foot.distance <= kNear * room_.aim()) return true;
  const Vec3 target = foot.point + room_.aim() / foot.distance * (p - foot.point);
  for (const double part : {1.0, 0.5, 0.25, 0.125}) {
    const Vec3 q = surface_.representable(p + part * (target - p));
    if (room_.allows(q) && surface_.move(v, q)) return part == 1;
  }
  return false;
}

const Foot& Fit::foot_of(std::uint32_t triangle, const Vec3& middle) const {
  if (triangle >= known_.size()) known_.resize(surface_.triangle_count());
  std::optional<NearestFoot>& known = known_[triangle];
  if (!known || known->middle != middle) {
    const std::uint32_t hint = known ? known->foot.triangle : hint_[surface_.triangle(triangle)[0]];
    known = NearestFoot{middle, obstacle_.foot(middle, hint)};
  }
  return known->foot;
}

Plane Fit::plane_of(std::uint32_t triangle) const {
  const geom::Triangle& t = surface_.triangle(triangle);
  const std::array<Vec3, 3> c{surface_.point(t[0]), surface_.point(t[1]), surface_.point(t[2])};
  const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double twice = normal.norm();
  if (!(twice > 0)) return {};
  const Vec3 middle = (c[0] + c[1] + c[2]) / 3;
  const Foot& foot = foot_of(triangle, middle);
  const Vec3 away = middle - foot.point;
  if (foot.distance > room_.far() || !(away.norm() > 0.01 * room_.offset))
    return {normal / twice, middle, twice / 2};
  return {away.normalized(), foot.point + room_.aim() * away.normalized(), twice / 2};
}

void Fit::settle() {
  std::vector<Plane> planes(surface_.triangle_count());
  for (std::uint32_t t = 0; t < planes.size(); ++t)
    if (!surface_.gone(t)) planes[t] = plane_of(t);
  for (std::uint32_t v = 0; v < surface_.vertex_count(); ++v)
    if (!surface_.star(v).empty()) settle(v, planes);
}

bool Fit::no_farther(const Vec3& from, const Vec3& to, std::uint32_t hint) const {
  if (obstacle_.within(to, room_.offset, hint)) return true;
  const Foot foot = obstacle_.foot(to, hint);
  return foot.distance <= obstacle_.foot(from, hint).distance;
}

void Fit::settle(std::uint32_t v, const std::vector<Plane>& planes) {
  const Vec3 p = surface_.point(v);
  Quadric sum;
  for (const std::uint32_t t : surface_.star(v))
    sum.add_plane(planes[t].normal, planes[t].point - p, planes[t].area);
  if (!(sum.weight > 0)) return;
  sum.add_point(Vec3::Zero(), 1e-3 * sum.weight);
  const Vec3 step = sum.minimiser(Vec3::Zero());
  const double length = step.norm();
  if (!(length > 0.1 * room_.aim())) return;
  const double most = std::min(1.0, 0.5 * room_.seal / length);
  for (const double part : {1.0, 0.5, 0.25}) {
    const Vec3 q = surface_.representable(p + part * most * step);
    if (sum.at(q - p) >= sum.c || !room_.allows(q) || !no_farther(p, q, hint_[v])) continue;
    if (surface_.move(v, q)) return;
  }
}

std::size_t Fit::refine() {
  struct Edge {
    std::uint32_t a, b;
  };
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < surface_.triangle_count(); ++t) {
    if (surface_.gone(t)) continue;
    const geom::Triangle& c = surface_.triangle(t);
    for (int i = 0; i < 3; ++i)
      if (c[i] < c[(i + 1) % 3]) edges.push_back({c[i], c[(i + 1) % 3]});
  }
  std::size_t splits = 0;
  for (const auto& [a, b] : edges) {
    const Vec3 &p = surface_.point(a), &q = surface_.point(b);
    if ((p - q).norm() < 2 * room_.offset) continue;
    const Vec3 middle = surface_.representable(0.5 * (p + q));
    std::uint32_t hint = hint_[a];
    if (!room_.allows(middle) || obstacle_.within(middle, room_.offset, hint)) continue;
    const std::uint32_t v = surface_.split(a, b, middle);
    if (v == Surface::kNone) continue;
    hint_.push_back(hint);
    approach(v);
    ++splits;
  }
  return splits;
}

}  // namespace kaboum::wrap
