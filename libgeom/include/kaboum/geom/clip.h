#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <optional>

namespace kaboum::geom {

/// A planar convex polygon that is cut into smaller ones, to bound distances piece by piece.
///
/// New corners are rounded, so the two parts of a cut cover the whole only up to kCutError times
/// the largest |coordinate|; who cuts repeatedly adds that up.
struct ConvexPolygon {
  static constexpr int kCapacity = 8;
  static constexpr double kCutError = 1e-15;

  std::array<Vec3, kCapacity> corner;  ///< the first `size` are valid
  int size = 0;

  ConvexPolygon() {}  // NOLINT(modernize-use-equals-default): leaves the corners alone
  ConvexPolygon(const Vec3& a, const Vec3& b, const Vec3& c) : size(3) {
    corner[0] = a;
    corner[1] = b;
    corner[2] = c;
  }
  ConvexPolygon(const ConvexPolygon& other) { *this = other; }
  ConvexPolygon& operator=(const ConvexPolygon& other) {
    size = other.size;
    for (int i = 0; i < size; ++i) corner[i] = other.corner[i];
    return *this;
  }
  ~ConvexPolygon() = default;

  [[nodiscard]] Vec3 centroid() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < size; ++i) sum += corner[i];
    return sum / size;
  }
};

/// Cuts by the plane through p with normal n. @return false when all corners lie on one side (or
/// within rounding of the plane); also when rounding has made the polygon so crooked that a part
/// would exceed the capacity. The parts are then undefined.
bool cut(const ConvexPolygon& polygon, const Vec3& p, const Vec3& n, ConvexPolygon& below,
         ConvexPolygon& above);

/// A plane through `point`; the normal has any length above 0.
struct CuttingPlane {
  Vec3 point, normal;
};

/// The plane on which the planes of two triangles are equally far, next to the point `near`: a
/// ridge of the distance to both, which halving would only approach. None where a triangle has no
/// area, or where the unit normals that look at `near` differ by less than √least.
std::optional<CuttingPlane> bisector(const std::array<Vec3, 3>& first,
                                     const std::array<Vec3, 3>& second, const Vec3& near,
                                     double least);

/// Cuts in two across its longest extent; a polygon at capacity is cut along a diagonal.
void halve(const ConvexPolygon& polygon, ConvexPolygon& first, ConvexPolygon& second);

/// Pieces of a polygon with respect to a triangle's prism (the points that project into it): at
/// most one piece inside and three outside.
struct PrismCut {
  static constexpr int kCuts = 3;  ///< that a point may undergo: what they leave out adds up
  std::array<ConvexPolygon, 4> piece;
  int count = 0;
};

/// Cuts along the prism of (a, b, c); halves instead when no side of the prism cuts the polygon, or
/// when `halving`. Always gives at least two pieces.
PrismCut cut_by_prism(const ConvexPolygon& polygon, const Vec3& a, const Vec3& b, const Vec3& c,
                      bool halving);

}  // namespace kaboum::geom
