#pragma once

#include <kaboum/geom/clip.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "change.h"
#include "closest_triangle.h"
#include "nearest_of.h"
#include "work.h"

namespace kaboum::bmesh {

using geom::Vec3;

/// Carried certificate that a changing mesh and its original stay within ε of each other.
///
/// Towards the original: a new triangle is cut into pieces until the corners of each piece are
/// within ε of one and the same original triangle; the distance to one triangle is convex, so the
/// whole piece is. From the original: every original triangle is covered by pieces, each carried by
/// a current triangle within ε of its corners. A change is admitted only if all pieces carried by
/// the triangles it removes, cut further where need be, find a new carrier. Where these are all
/// pieces of an original triangle, it is cut anew.
/// docs/algorithms/bounding-mesh.md, "The error bound".
class ErrorBoundCertificate {
 public:
  using NewTriangle = bmesh::NewTriangle;

  /// @param original  carried initially triangle by triangle: triangle i of the current mesh is
  ///   triangle i of the original. It must outlive this object.
  /// @param work  counts what is done, if not null.
  ErrorBoundCertificate(const geom::Mesh& original, double epsilon, Work* work = nullptr);

  /// Distances to the original, for others to ask, too.
  [[nodiscard]] const std::shared_ptr<const ClosestTriangle>& closest() const { return near_; }

  /// Lets ε be larger from now on.
  void raise(double epsilon);

  /// Whether triangles `removed` may be replaced by `added` (which reuse some of their indices).
  [[nodiscard]] bool admits(std::span<const std::uint32_t> removed,
                            std::span<const NewTriangle> added);
  /// Carries out the change that `admits` has just accepted.
  void commit(std::span<const std::uint32_t> removed);

  /// Into how many pieces the original is cut.
  [[nodiscard]] std::size_t pieces() const;

 private:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr int kMaxCuts = 9;       ///< of one piece in one change
  static constexpr int kMaxPieces = 2000;  ///< tried in one change

  /// A piece that is no whole triangle of the original.
  struct Part {
    std::array<Vec3, 3> corner;
    std::uint32_t of;    ///< the triangle
    std::uint32_t cuts;  ///< that led to it
    std::uint32_t next;
  };
  /// A piece, whole or a part, and what carries it.
  struct CarriedTriangle {
    std::array<Vec3, 3> corner;
    std::uint32_t of, cuts, carrier;
  };
  /// A piece that is to be placed.
  struct Placing {
    std::span<const NewTriangle> added;
    NearestOf nearest;
    std::uint32_t of;
  };

  /// Calls visit(piece) for all that triangle t carries.
  template <class Visit>
  void for_each_piece(std::uint32_t t, Visit&& visit) const {
    for (std::uint32_t p = head_[t]; p != kNone; p = p < next_.size() ? next_[p] : part(p).next)
      visit(p);
  }
  [[nodiscard]] const Part& part(std::uint32_t piece) const { return parts_[piece - next_.size()]; }
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t piece) const {
    return piece < next_.size() ? piece : part(piece).of;
  }
  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const;

  [[nodiscard]] bool places_all(std::span<const std::uint32_t> removed, Placing& placing);
  [[nodiscard]] bool place_anew(std::uint32_t triangle, Placing& placing);
  [[nodiscard]] bool place(const geom::ConvexPolygon& piece, std::uint32_t cuts, Placing& placing,
                           int cuts_left);
  void put(const geom::ConvexPolygon& piece, std::uint32_t cuts, std::uint32_t of,
           std::uint32_t carrier);
  [[nodiscard]] bool carries(const NewTriangle& triangle, const geom::ConvexPolygon& piece) const;
  std::uint32_t allocate();

  [[nodiscard]] bool is_near(const std::array<Vec3, 3>& triangle);

  const geom::Mesh& original_;
  std::shared_ptr<const ClosestTriangle> near_;
  double magnitude_;  // of the original's coordinates
  double epsilon_;
  // Pieces by numbers: whole triangles of the original have their own, then come parts.
  std::vector<std::uint32_t> head_;    // per current triangle
  std::vector<std::uint32_t> next_;    // per triangle of the original, where it is carried whole
  std::vector<std::uint32_t> pieces_;  // how many there are of it
  std::vector<Part> parts_;
  std::uint32_t free_ = kNone;
  std::vector<CarriedTriangle> placed_;  // of the change under consideration
  std::vector<char> may_carry_;          // of the new triangles
  std::size_t last_carrier_ = 0;
  int pieces_left_ = 0;
  std::uint32_t hint_ = 0;
  std::uint64_t steps_ = 0;  // of the change under consideration
  Work* work_;
};

}  // namespace kaboum::bmesh
