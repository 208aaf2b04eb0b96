#pragma once

#include <kaboum/geom/convex_hull.h>

#include <utility>
#include <vector>

#include "concavity.h"
#include "piece.h"

namespace kaboum::bcd {

/// A piece of the solid in the tree of cuts, and its hull.
struct CutNode {
  Piece piece;             ///< empty once cut
  std::vector<Vec3> hull;  ///< vertices of the hull
  Concavity concavity;
  int parent = -1, lower = -1, upper = -1;
  Plane plane;
  bool stuck = false;  ///< no plane makes it better
  int stale_cuts = 0;  ///< cuts above it that brought neither half nearer
};

CutNode make_node(Piece&& piece, const SolidField& solid);

/// The least and the largest of the points' coordinates along n.
std::pair<double, double> extent(const std::vector<Vec3>& points, const Vec3& n);

/// Appends the hull points of what is on either side of a plane. @return
/// whether there is something on both. @param shift  as of classify
bool append_sides(const Piece& piece, const Plane& plane, const SolidField& solid, double shift,
                  std::vector<Vec3>& lower, std::vector<Vec3>& upper);

/// Room that cutting needs again and again, one for each thread.
struct CutScratch {
  geom::HullBuilder builder;
  std::vector<double> height;
  std::vector<Side> side;
  std::vector<Vec3> lower, upper;
  std::vector<char> mark;
};
CutScratch& cut_scratch();

}  // namespace kaboum::bcd
