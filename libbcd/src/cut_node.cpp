// Pieces in the tree of cuts, and what of a piece is on either side of a plane.

#include "cut_node.h"

#include <algorithm>
#include <limits>

namespace kaboum::bcd {
namespace {

/// About what a polygon takes. [ns]
constexpr std::uint64_t kPolygonWork = 40;
/// Points of a cell's edges count as inside the solid from this share of the
/// grid's spacing on.
constexpr double kInside = 0.25;

}  // namespace

CutScratch& cut_scratch() {
  static thread_local CutScratch s;
  return s;
}

std::pair<double, double> extent(const std::vector<Vec3>& points, const Vec3& n) {
  std::pair<double, double> out{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  for (const Vec3& p : points) {
    out.first = std::min(out.first, n.dot(p));
    out.second = std::max(out.second, n.dot(p));
  }
  return out;
}

CutNode make_node(Piece&& piece, const SolidField& solid) {
  CutNode node;
  geom::HullBuilder& builder = cut_scratch().builder;
  const std::vector<Vec3> points = piece.hull_points();
  node.concavity = estimate_concavity(points, solid, builder);
  if (!node.concavity.flat) {
    for (const std::uint32_t v : builder.vertices()) node.hull.push_back(points[v]);
  } else {
    node.hull = points;
  }
  node.piece = std::move(piece);
  return node;
}

bool append_sides(const Piece& piece, const Plane& plane, const SolidField& solid, double shift,
                  std::vector<Vec3>& lower, std::vector<Vec3>& upper) {
  CutScratch& s = cut_scratch();
  classify(piece, plane, solid, shift, s.height, s.side);
  s.mark.assign(piece.points.size(), 0);
  solid.work().add(kPolygonWork * piece.polygons());
  bool any[2]{};
  for (std::size_t f = 0; f < s.side.size(); ++f) {
    const std::uint32_t first = piece.start[f], last = piece.start[f + 1];
    if (s.side[f] != Side::Both) {
      const char bit = s.side[f] == Side::Lower ? 1 : 2;
      any[bit - 1] = true;
      for (std::uint32_t k = first; k < last; ++k) s.mark[piece.corner[k]] |= bit;
      continue;
    }
    any[0] = any[1] = true;
    for (std::uint32_t k = first; k < last; ++k) {
      const std::uint32_t a = piece.corner[k];
      const std::uint32_t b = piece.corner[k + 1 < last ? k + 1 : first];
      const double ha = s.height[a], hb = s.height[b];
      s.mark[a] |= static_cast<char>((ha <= 0 ? 1 : 0) | (ha >= 0 ? 2 : 0));
      if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0)) {
        const Vec3 p = piece.points[a] + (ha / (ha - hb)) * (piece.points[b] - piece.points[a]);
        lower.push_back(p);
        upper.push_back(p);
      }
    }
  }
  if (!any[0] || !any[1]) return false;
  for (std::size_t i = 0; i < piece.points.size(); ++i) {
    if ((s.mark[i] & 1) != 0) lower.push_back(piece.points[i]);
    if ((s.mark[i] & 2) != 0) upper.push_back(piece.points[i]);
  }
  const Cell& cell = piece.cell;
  for (std::size_t i = 0; i < cell.corners.size(); ++i)
    if (piece.inside[i] != 0)
      (plane.height(cell.corners[i]) <= 0 ? lower : upper).push_back(cell.corners[i]);
  for (const auto& [a, b] : cell.edges()) {
    const double ha = plane.height(cell.corners[a]), hb = plane.height(cell.corners[b]);
    if (!((ha < 0 && hb > 0) || (ha > 0 && hb < 0))) continue;
    const Vec3 p = cell.corners[a] + (ha / (ha - hb)) * (cell.corners[b] - cell.corners[a]);
    if (solid.field(p) >= -kInside * solid.spacing()) continue;
    lower.push_back(p);
    upper.push_back(p);
  }
  return true;
}

}  // namespace kaboum::bcd
