#include "tolerance.h"

namespace kaboum::bmesh {
namespace {

using Triangle3 = std::array<Vec3, 3>;

/// The four quarters of a triangle. Midpoints are rounded, so the quarters miss points of the whole by
/// up to 2^-53 of the coordinates; the caller's ε is lowered by more than that.
std::array<Triangle3, 4> quarters(const Triangle3& t) {
  const Vec3 m01 = 0.5 * t[0] + 0.5 * t[1], m12 = 0.5 * t[1] + 0.5 * t[2],
             m20 = 0.5 * t[2] + 0.5 * t[0];
  return {{{t[0], m01, m20}, {m01, t[1], m12}, {m20, m12, t[2]}, {m01, m12, m20}}};
}

}  // namespace

Tolerance::Tolerance(const geom::Mesh& original, double epsilon)
    : original_(original), head_(original.triangles.size(), kNone) {
  const geom::Box3& box = original_.box();
  const double magnitude = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  epsilon_ = epsilon - (magnitude + epsilon) * (kMaxSplits + 2) * 4.5e-16;
  pieces_.reserve(original.triangles.size());
  for (std::uint32_t t = 0; t < original.triangles.size(); ++t) {
    const geom::Triangle& tri = original.triangles[t];
    head_[t] = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back(
        {{original.vertices[tri[0]], original.vertices[tri[1]], original.vertices[tri[2]]}, kNone});
  }
}

std::uint32_t Tolerance::allocate() {
  if (free_ == kNone) {
    pieces_.emplace_back();
    return static_cast<std::uint32_t>(pieces_.size() - 1);
  }
  const std::uint32_t p = free_;
  free_ = pieces_[p].next;
  return p;
}

bool Tolerance::near_original(const Triangle3& triangle, std::uint32_t hint, int splits_left) const {
  const Vec3 center = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
  const geom::DistanceQuery::Nearest at = original_.nearest(center, hint);
  if (at.upper > epsilon_) return false;
  const auto covered_by = [&](std::uint32_t t) {
    for (const Vec3& c : triangle)
      if (original_.to_triangle(c, t).upper > epsilon_) return false;
    return true;
  };
  if (covered_by(at.triangle)) return true;
  // Every point is within the radius about the centre of it.
  double radius = 0;
  for (const Vec3& c : triangle) radius = std::max(radius, (c - center).norm());
  if (at.upper + radius * (1 + 1e-15) <= epsilon_) return true;
  if (splits_left == 0) return false;
  for (const Triangle3& q : quarters(triangle))
    if (!near_original(q, at.triangle, splits_left - 1)) return false;
  return true;
}

bool Tolerance::place(const Triangle3& piece, std::span<const NewTriangle> added, int splits_left) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    const std::size_t k = (last_carrier_ + i) % added.size();
    const auto& [a, b, c] = added[k].corner;
    bool near = true;
    for (const Vec3& p : piece)
      near = near && geom::point_triangle_distance(p, a, b, c).upper <= epsilon_;
    if (!near) continue;
    last_carrier_ = k;
    placed_.push_back({piece, added[k].index});
    return true;
  }
  if (splits_left == 0) return false;
  // A corner out of reach of all new triangles cannot be helped by splitting.
  for (const Vec3& p : piece) {
    bool reached = false;
    for (const NewTriangle& t : added)
      reached = reached ||
                geom::point_triangle_distance(p, t.corner[0], t.corner[1], t.corner[2]).upper <= epsilon_;
    if (!reached) return false;
  }
  for (const Triangle3& q : quarters(piece))
    if (!place(q, added, splits_left - 1)) return false;
  return true;
}

bool Tolerance::admits(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added) {
  placed_.clear();
  last_carrier_ = 0;
  if (added.empty()) return false;
  for (const std::uint32_t t : removed)
    for (std::uint32_t p = head_[t]; p != kNone; p = pieces_[p].next)
      if (!place(pieces_[p].corner, added, kMaxSplits)) return false;
  std::uint32_t hint = geom::DistanceQuery::kNone;
  for (const NewTriangle& t : added)
    if (!near_original(t.corner, hint, kMaxSplits)) return false;
  return true;
}

void Tolerance::commit(std::span<const std::uint32_t> removed) {
  for (const std::uint32_t t : removed) {
    std::uint32_t p = head_[t];
    head_[t] = kNone;
    while (p != kNone) {
      const std::uint32_t next = pieces_[p].next;
      pieces_[p].next = free_;
      free_ = p;
      p = next;
    }
  }
  for (const Placed& placed : placed_) {
    const std::uint32_t p = allocate();
    pieces_[p] = {placed.corner, head_[placed.carrier]};
    head_[placed.carrier] = p;
  }
}

}  // namespace kaboum::bmesh
