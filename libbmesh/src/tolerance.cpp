#include "tolerance.h"

#include <algorithm>
#include <limits>

namespace kaboum::bmesh {
namespace {

/// Cuts by prisms that may lead to one piece over the whole run: what their rounding may leave
/// uncovered is taken off ε beforehand.
constexpr std::uint32_t kMaxTotalCuts = 1000;

/// Pieces that a new triangle may fall into: large ones along an edge of the original need many.
constexpr int kMaxCells = 4000;

}  // namespace

Tolerance::Tolerance(const geom::Mesh& original, double epsilon)
    : original_(original), head_(original.triangles.size(), kNone) {
  raise(epsilon);
  pieces_.reserve(original.triangles.size());
  for (std::uint32_t t = 0; t < original.triangles.size(); ++t) {
    const geom::Triangle& tri = original.triangles[t];
    head_[t] = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back(
        {{original.vertices[tri[0]], original.vertices[tri[1]], original.vertices[tri[2]]},
         0,
         kNone});
  }
}

void Tolerance::raise(double epsilon) {
  const geom::Box3& box = original_.box();
  const double magnitude = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  epsilon_ = epsilon - (magnitude + epsilon) * kMaxTotalCuts * geom::PrismCut::kCuts *
                           geom::ConvexPolygon::kCutError;
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

bool Tolerance::carries(const NewTriangle& triangle, const geom::ConvexPolygon& piece) const {
  const auto& [a, b, c] = triangle.corner;
  for (int i = 0; i < piece.size; ++i)
    if (!(geom::point_triangle_distance(piece.corner[i], a, b, c).upper <= epsilon_)) return false;
  return true;
}

void Tolerance::put(const geom::ConvexPolygon& piece, std::uint32_t cuts, std::uint32_t carrier) {
  for (int i = 2; i < piece.size; ++i)
    placed_.push_back({{piece.corner[0], piece.corner[i - 1], piece.corner[i]}, cuts, carrier});
}

bool Tolerance::place(const geom::ConvexPolygon& piece, std::uint32_t cuts,
                      std::span<const NewTriangle> added, int cuts_left) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    const std::size_t k = (last_carrier_ + i) % added.size();
    if (!carries(added[k], piece)) continue;
    last_carrier_ = k;
    put(piece, cuts, added[k].index);
    return true;
  }
  if (cuts_left == 0 || cuts >= kMaxTotalCuts || --pieces_left_ < 0) return false;
  // Cut along the prism of the new triangle nearest to the middle; if that is too far, no cut
  // helps.
  const Vec3 center = piece.centroid();
  std::size_t nearest = 0;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < added.size(); ++k) {
    const auto& [a, b, c] = added[k].corner;
    const double d = geom::point_triangle_distance(center, a, b, c).upper;
    if (d >= distance) continue;
    distance = d;
    nearest = k;
  }
  if (!(distance <= epsilon_)) return false;
  const auto& [a, b, c] = added[nearest].corner;
  const geom::PrismCut pieces = geom::cut_by_prism(piece, a, b, c, cuts_left % 3 == 0);
  last_carrier_ = nearest;
  for (int i = 0; i < pieces.count; ++i)
    if (!place(pieces.piece[i], cuts + 1, added, cuts_left - 1)) return false;
  return true;
}

bool Tolerance::admits(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added) {
  placed_.clear();
  last_carrier_ = 0;
  pieces_left_ = kMaxPieces;
  if (added.empty()) return false;
  for (const std::uint32_t t : removed) {
    for (std::size_t i = 0; i < added.size(); ++i)
      if (added[i].index == t) last_carrier_ = i;
    for (std::uint32_t p = head_[t]; p != kNone; p = pieces_[p].next)
      if (const auto& [a, b, c] = pieces_[p].corner;
          !place({a, b, c}, pieces_[p].cuts, added, kMaxCuts))
        return false;
  }
  return std::all_of(added.begin(), added.end(), [&](const NewTriangle& t) {
    return original_.all_within({t.corner[0], t.corner[1], t.corner[2]}, epsilon_, kMaxCells);
  });
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
    pieces_[p] = {placed.corner, placed.cuts, head_[placed.carrier]};
    head_[placed.carrier] = p;
  }
}

}  // namespace kaboum::bmesh
