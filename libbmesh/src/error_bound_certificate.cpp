// A carried certificate that a mesh and its original stay near each other.
// docs/algorithms/bounding-mesh.md, "The error bound".

#include "error_bound_certificate.h"

#include <kaboum/geom/points_near.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace kaboum::bmesh {
namespace {

/// Cuts by prisms that may lead to one piece over the whole run: what their rounding may leave
/// uncovered is taken off ε beforehand.
constexpr std::uint32_t kMaxTotalCuts = 1000;

/// About the nanoseconds that it takes to look whether a triangle carries a piece, and to cut one.
constexpr std::uint64_t kCarry = 50, kCut = 300;

/// Instead of how many pieces of a triangle are left: it has been cut anew, or could not be.
constexpr std::uint32_t kPlaced = ~0U, kPieceByPiece = ~0U - 1;

/// Pieces that a new triangle may fall into: large ones along an edge of the original need many.
constexpr int kMaxCells = 4000;

std::span<const Vec3> corners_of(const geom::ConvexPolygon& polygon) {
  return {polygon.corner.data(), static_cast<std::size_t>(polygon.size)};
}

}  // namespace

ErrorBoundCertificate::ErrorBoundCertificate(const geom::Mesh& original, double epsilon, Work* work)
    : original_(original),
      near_(std::make_shared<const ClosestTriangle>(original)),
      magnitude_(geom::bounding_box(original)
                     .min.cwiseAbs()
                     .cwiseMax(geom::bounding_box(original).max.cwiseAbs())
                     .maxCoeff()),
      head_(original.triangles.size()),
      next_(original.triangles.size(), kNone),
      pieces_(original.triangles.size(), 1),
      work_(work) {
  raise(epsilon);
  std::iota(head_.begin(), head_.end(), 0U);
}

std::array<Vec3, 3> ErrorBoundCertificate::corners(std::uint32_t triangle) const {
  const geom::Triangle& t = original_.triangles[triangle];
  return {original_.vertices[t[0]], original_.vertices[t[1]], original_.vertices[t[2]]};
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
      const auto [a, b, c] = near_->corners(hint_);
      return geom::all_within(corners_of(e.polygon), a, b, c, epsilon_);
    };
    const Vec3 middle = e.polygon.centroid();
    const double most = epsilon_ * epsilon_;
    if (near_->squared_near(middle, hint_) > most) {
      if (!(near_->squared(middle, hint_, 0, &steps_) <= most)) return false;
    }
    if (is_covered()) continue;
    const auto [a, b, c] = near_->corners(hint_);
    const geom::PrismCut pieces = geom::cut_by_prism(e.polygon, a, b, c, e.depth % 3 == 2);
    if (size + pieces.count > kStack) return false;
    for (int i = 0; i < pieces.count; ++i) stack[size++] = {pieces.piece[i], e.depth + 1};
  }
  return true;
}

std::size_t ErrorBoundCertificate::pieces() const {
  return std::accumulate(pieces_.begin(), pieces_.end(), std::size_t{0});
}

std::uint32_t ErrorBoundCertificate::allocate() {
  if (free_ == kNone) {
    parts_.emplace_back();
    return static_cast<std::uint32_t>(parts_.size() - 1);
  }
  const std::uint32_t p = free_;
  free_ = parts_[p].next;
  return p;
}

bool ErrorBoundCertificate::carries(const NewTriangle& triangle,
                                    const geom::ConvexPolygon& piece) const {
  const auto& [a, b, c] = triangle.corner;
  return geom::all_within(corners_of(piece), a, b, c, epsilon_);
}

void ErrorBoundCertificate::put(const geom::ConvexPolygon& piece, std::uint32_t cuts,
                                std::uint32_t of, std::uint32_t carrier) {
  for (int i = 2; i < piece.size; ++i)
    placed_.push_back({{piece.corner[0], piece.corner[i - 1], piece.corner[i]}, of, cuts, carrier});
}

bool ErrorBoundCertificate::place(const geom::ConvexPolygon& piece, std::uint32_t cuts,
                                  Placing& placing, int cuts_left) {
  const std::span<const NewTriangle> added = placing.added;
  const auto is_carried_by = [&](std::size_t k) {
    if (!carries(added[k], piece)) return false;
    last_carrier_ = k;
    put(piece, cuts, placing.of, added[k].index);
    return true;
  };
  const std::size_t last = last_carrier_;
  steps_ += kCarry;
  if (is_carried_by(last)) return true;
  steps_ += piece.size * placing.nearest.steps();
  // Most are too far from some corner by bounds that cost little.
  may_carry_.assign(added.size(), 1);
  may_carry_[last] = 0;
  for (int i = 0; i < piece.size; ++i)
    placing.nearest.within(piece.corner[i], epsilon_ * epsilon_, may_carry_);
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
  const double distance = placing.nearest.squared(center, nearest);
  if (!(distance <= epsilon_ * epsilon_)) return false;
  const auto& [a, b, c] = added[nearest].corner;
  const geom::PrismCut pieces = geom::cut_by_prism(piece, a, b, c, cuts_left % 3 == 0);
  last_carrier_ = nearest;
  for (int i = 0; i < pieces.count; ++i)
    if (!place(pieces.piece[i], cuts + 1, placing, cuts_left - 1)) return false;
  return true;
}

/// Places a whole triangle of the original, or nothing.
bool ErrorBoundCertificate::place_anew(std::uint32_t triangle, Placing& placing) {
  const std::size_t before = placed_.size();
  const auto [a, b, c] = corners(triangle);
  placing.of = triangle;
  if (place({a, b, c}, 0, placing, kMaxCuts)) return true;
  placed_.resize(before);
  return false;
}

/// Places all that the triangles carry. @pre pieces_ has what the others carry
bool ErrorBoundCertificate::places_all(std::span<const std::uint32_t> removed, Placing& placing) {
  for (const std::uint32_t t : removed) {
    for (std::size_t i = 0; i < placing.added.size(); ++i)
      if (placing.added[i].index == t) last_carrier_ = i;
    bool all = true;
    for_each_piece(t, [&](std::uint32_t p) {
      if (!all) return;
      placing.of = triangle_of(p);
      std::uint32_t& left = pieces_[placing.of];
      if (left == 0) left = place_anew(placing.of, placing) ? kPlaced : kPieceByPiece;
      if (left == kPlaced) return;
      if (p < next_.size()) {
        all = false;
        return;
      }
      const Part& q = part(p);
      all = place({q.corner[0], q.corner[1], q.corner[2]}, q.cuts, placing, kMaxCuts);
    });
    if (!all) return false;
  }
  return true;
}

bool ErrorBoundCertificate::admits(std::span<const std::uint32_t> removed,
                                   std::span<const NewTriangle> added) {
  placed_.clear();
  last_carrier_ = 0;
  pieces_left_ = kMaxPieces;
  if (added.empty() || !(epsilon_ > 0)) return false;
  steps_ = 0;
  for (const std::uint32_t t : removed)
    for_each_piece(t, [&](std::uint32_t p) { --pieces_[triangle_of(p)]; });
  Placing placing{added, NearestOf(added), kNone};
  const bool placed = places_all(removed, placing);
  for (const std::uint32_t t : removed)
    for_each_piece(t, [&](std::uint32_t p) {
      std::uint32_t& left = pieces_[triangle_of(p)];
      if (left == kPlaced || left == kPieceByPiece) left = 0;
      ++left;
    });
  const bool admitted = placed && std::all_of(added.begin(), added.end(),
                                              [&](const auto& t) { return is_near(t.corner); });
  count(work_, steps_);
  return admitted;
}

void ErrorBoundCertificate::commit(std::span<const std::uint32_t> removed) {
  const auto wholes = static_cast<std::uint32_t>(next_.size());
  for (const std::uint32_t t : removed) {
    std::uint32_t p = head_[t];
    head_[t] = kNone;
    while (p != kNone) {
      --pieces_[triangle_of(p)];
      std::uint32_t& link = p < wholes ? next_[p] : parts_[p - wholes].next;
      const std::uint32_t next = link;
      link = p < wholes ? kNone : free_;
      if (p >= wholes) free_ = p - wholes;
      p = next;
    }
  }
  for (const CarriedTriangle& placed : placed_) {
    std::uint32_t& head = head_[placed.carrier];
    ++pieces_[placed.of];
    if (placed.cuts == 0) {
      next_[placed.of] = head;
      head = placed.of;
      continue;
    }
    const std::uint32_t p = allocate();
    parts_[p] = {placed.corner, placed.of, placed.cuts, head};
    head = wholes + p;
  }
}

}  // namespace kaboum::bmesh
