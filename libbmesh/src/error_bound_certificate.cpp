// A carried certificate that a mesh and its original stay near each other.
// docs/algorithms/bounding-mesh.md, "The error bound".

#include "error_bound_certificate.h"

#include <kaboum/geom/point_triangle.h>

#include <algorithm>
#include <limits>

namespace kaboum::bmesh {
namespace {

/// Cuts by prisms that may lead to one piece over the whole run: what their rounding may leave
/// uncovered is taken off ε beforehand.
constexpr std::uint32_t kMaxTotalCuts = 1000;

/// About the nanoseconds that it takes to look whether a triangle carries a piece, and to cut one.
constexpr std::uint64_t kCarry = 50, kCut = 300;

/// Pieces that a new triangle may fall into: large ones along an edge of the original need many.
constexpr int kMaxCells = 4000;

}  // namespace

ErrorBoundCertificate::ErrorBoundCertificate(const geom::Mesh& original, double epsilon, Work* work)
    : near_(original),
      magnitude_(geom::bounding_box(original)
                     .min.cwiseAbs()
                     .cwiseMax(geom::bounding_box(original).max.cwiseAbs())
                     .maxCoeff()),
      head_(original.triangles.size(), kNone),
      work_(work) {
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

void ErrorBoundCertificate::raise(double epsilon) {
  epsilon_ = epsilon - (magnitude_ + epsilon) * kMaxTotalCuts * geom::PrismCut::kCuts *
                           geom::ConvexPolygon::kCutError;
}

/// Whether every point of the triangle is within ε of the original. Where it is looked for is a
/// guess in rounded arithmetic; what accepts are upper bounds of the corners' distances.
bool ErrorBoundCertificate::is_near(const std::array<Vec3, 3>& triangle) {
  struct Entry {
    geom::ConvexPolygon polygon;
    int depth;
  };
  constexpr int kStack = 96;
  std::array<Entry, kStack> stack;
  int size = 0;
  stack[size++] = {{triangle[0], triangle[1], triangle[2]}, 0};
  for (int cells = kMaxCells; size > 0;) {
    const Entry e = stack[--size];
    if (--cells < 0) return false;
    steps_ += kCut;
    const auto is_covered = [&] {
      const std::array<Vec3, 3> t = near_.corners(hint_);
      return std::all_of(e.polygon.corner.begin(), e.polygon.corner.begin() + e.polygon.size,
                         [&](const Vec3& p) {
                           return geom::point_triangle_upper(p, t[0], t[1], t[2]) <= epsilon_;
                         });
    };
    const Vec3 middle = e.polygon.centroid();
    const double most = epsilon_ * epsilon_;
    if (near_.squared_near(middle, hint_) <= most && is_covered()) continue;
    const std::uint32_t found = hint_;
    if (!(near_.squared(middle, hint_, 0, &steps_) <= most)) return false;
    if (hint_ != found && is_covered()) continue;
    const auto [a, b, c] = near_.corners(hint_);
    const geom::PrismCut pieces = geom::cut_by_prism(e.polygon, a, b, c, e.depth % 3 == 2);
    if (size + pieces.count > kStack) return false;
    for (int i = 0; i < pieces.count; ++i) stack[size++] = {pieces.piece[i], e.depth + 1};
  }
  return true;
}

std::uint32_t ErrorBoundCertificate::allocate() {
  if (free_ == kNone) {
    pieces_.emplace_back();
    return static_cast<std::uint32_t>(pieces_.size() - 1);
  }
  const std::uint32_t p = free_;
  free_ = pieces_[p].next;
  return p;
}

bool ErrorBoundCertificate::carries(const NewTriangle& triangle,
                                    const geom::ConvexPolygon& piece) const {
  const auto& [a, b, c] = triangle.corner;
  for (int i = 0; i < piece.size; ++i)
    if (!(geom::point_triangle_upper(piece.corner[i], a, b, c) <= epsilon_)) return false;
  return true;
}

void ErrorBoundCertificate::put(const geom::ConvexPolygon& piece, std::uint32_t cuts,
                                std::uint32_t carrier) {
  for (int i = 2; i < piece.size; ++i)
    placed_.push_back({{piece.corner[0], piece.corner[i - 1], piece.corner[i]}, cuts, carrier});
}

bool ErrorBoundCertificate::place(const geom::ConvexPolygon& piece, std::uint32_t cuts,
                                  std::span<const NewTriangle> added, NearestOf& nearest_of,
                                  int cuts_left) {
  const auto is_carried_by = [&](std::size_t k) {
    if (!carries(added[k], piece)) return false;
    last_carrier_ = k;
    put(piece, cuts, added[k].index);
    return true;
  };
  const std::size_t last = last_carrier_;
  steps_ += kCarry;
  if (is_carried_by(last)) return true;
  steps_ += piece.size * nearest_of.steps();
  // Most are too far from some corner by bounds that cost little.
  may_carry_.assign(added.size(), 1);
  may_carry_[last] = 0;
  for (int i = 0; i < piece.size; ++i)
    nearest_of.within(piece.corner[i], epsilon_ * epsilon_, may_carry_);
  for (std::size_t i = 1; i < added.size(); ++i) {
    const std::size_t k = (last + i) % added.size();
    if (may_carry_[k] == 0) continue;
    steps_ += kCarry;
    if (is_carried_by(k)) return true;
  }
  if (cuts_left == 0 || cuts >= kMaxTotalCuts || --pieces_left_ < 0) return false;
  // Cut along the prism of the new triangle nearest to the middle; if that is too far, no cut
  // helps.
  steps_ += kCut;
  const Vec3 center = piece.centroid();
  std::size_t nearest = last;
  const double distance = nearest_of.squared(center, nearest);
  if (!(distance <= epsilon_ * epsilon_)) return false;
  const auto& [a, b, c] = added[nearest].corner;
  const geom::PrismCut pieces = geom::cut_by_prism(piece, a, b, c, cuts_left % 3 == 0);
  last_carrier_ = nearest;
  for (int i = 0; i < pieces.count; ++i)
    if (!place(pieces.piece[i], cuts + 1, added, nearest_of, cuts_left - 1)) return false;
  return true;
}

bool ErrorBoundCertificate::admits(std::span<const std::uint32_t> removed,
                                   std::span<const NewTriangle> added) {
  placed_.clear();
  last_carrier_ = 0;
  pieces_left_ = kMaxPieces;
  if (added.empty() || !(epsilon_ > 0)) return false;
  NearestOf nearest(added);
  steps_ = 0;
  const auto is_placed = [&](std::uint32_t t) {
    for (std::size_t i = 0; i < added.size(); ++i)
      if (added[i].index == t) last_carrier_ = i;
    for (std::uint32_t p = head_[t]; p != kNone; p = pieces_[p].next)
      if (const auto& [a, b, c] = pieces_[p].corner;
          !place({a, b, c}, pieces_[p].cuts, added, nearest, kMaxCuts))
        return false;
    return true;
  };
  const bool admitted = std::all_of(removed.begin(), removed.end(), is_placed) &&
                        std::all_of(added.begin(), added.end(),
                                    [&](const NewTriangle& t) { return is_near(t.corner); });
  count(work_, steps_);
  return admitted;
}

void ErrorBoundCertificate::commit(std::span<const std::uint32_t> removed) {
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
  for (const CarriedTriangle& placed : placed_) {
    const std::uint32_t p = allocate();
    pieces_[p] = {placed.corner, placed.cuts, head_[placed.carrier]};
    head_[placed.carrier] = p;
  }
}

}  // namespace kaboum::bmesh
