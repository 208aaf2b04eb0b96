#pragma once

#include <cstdint>
#include <vector>

#include "cell.h"
#include "solid_field.h"

namespace kaboum::bcd {

/// What of the solid lies in a cell: the input's triangles clipped to it, and the cell's corners
/// that lie in the solid. The hull of both contains the solid's part (docs/algorithms/
/// convex-decomposition.md, "Cells").
struct Piece {
  std::vector<Vec3> points;
  std::vector<char> exact;            ///< per point: a vertex of the input, not computed
  std::vector<std::uint32_t> start;   ///< per polygon and one more: its first entry of `corner`
  std::vector<std::uint32_t> corner;  ///< indices of points, loop after loop
  std::vector<std::uint32_t> source;  ///< per polygon: triangle of the input
  Cell cell;
  std::vector<char> inside;  ///< per corner of the cell: in the solid

  [[nodiscard]] std::size_t polygons() const { return source.size(); }
  [[nodiscard]] bool empty() const;
  /// Points whose hull is the body: polygons' corners and inside corners.
  [[nodiscard]] std::vector<Vec3> hull_points() const;
};

/// Which side(s) of a plane a polygon belongs to.
enum class Side : char { Lower, Upper, Both };

/// The whole of the solid in one cell.
Piece whole(const SolidField& solid);

/// Heights of the points, and the side of every polygon. Polygons within `shift` of the plane go to
/// the side that their solid is on.
void classify(const Piece& piece, const Plane& plane, const SolidField& solid, double shift,
              std::vector<double>& height, std::vector<Side>& side);

/// The part on one side; parts of both sides overlap by twice `shift`.
Piece clip(const Piece& piece, const Plane& plane, bool lower, double shift,
           const SolidField& solid, const std::vector<double>& height,
           const std::vector<Side>& side);

}  // namespace kaboum::bcd
