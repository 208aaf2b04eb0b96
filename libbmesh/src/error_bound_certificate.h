#pragma once

#include <kaboum/geom/clip.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
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
/// the triangles it removes, cut further where need be, find a new carrier.
/// docs/algorithms/bounding-mesh.md, "The error bound".
class ErrorBoundCertificate {
 public:
  using NewTriangle = bmesh::NewTriangle;

  /// @param original  carried initially triangle by triangle: triangle i of the current mesh is
  ///   triangle i of the original. It must outlive this object.
  /// @param work  counts what is done, if not null.
  ErrorBoundCertificate(const geom::Mesh& original, double epsilon, Work* work = nullptr);

  /// Lets ε be larger from now on.
  void raise(double epsilon);

  /// Whether triangles `removed` may be replaced by `added` (which reuse some of their indices).
  [[nodiscard]] bool admits(std::span<const std::uint32_t> removed,
                            std::span<const NewTriangle> added);
  /// Carries out the change that `admits` has just accepted.
  void commit(std::span<const std::uint32_t> removed);

 private:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr int kMaxCuts = 9;       ///< of one piece in one change
  static constexpr int kMaxPieces = 2000;  ///< tried in one change

  struct PolygonPart {
    std::array<Vec3, 3> corner;
    std::uint32_t cuts;  ///< that led to it, since the beginning
    std::uint32_t next;
  };
  struct CarriedTriangle {
    std::array<Vec3, 3> corner;
    std::uint32_t cuts;
    std::uint32_t carrier;
  };

  [[nodiscard]] bool place(const geom::ConvexPolygon& piece, std::uint32_t cuts,
                           std::span<const NewTriangle> added, NearestOf& nearest, int cuts_left);
  void put(const geom::ConvexPolygon& piece, std::uint32_t cuts, std::uint32_t carrier);
  [[nodiscard]] bool carries(const NewTriangle& triangle, const geom::ConvexPolygon& piece) const;
  std::uint32_t allocate();

  [[nodiscard]] bool is_near(const std::array<Vec3, 3>& triangle);

  ClosestTriangle near_;
  double magnitude_;  // of the original's coordinates
  double epsilon_;
  std::vector<PolygonPart> pieces_;
  std::vector<std::uint32_t> head_;  // per current triangle
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
