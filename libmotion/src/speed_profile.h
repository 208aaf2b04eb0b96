#pragma once

#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/trajectory.h>

#include <span>
#include <vector>

namespace kaboum::motion {

/// Part of a piece along which the acceleration of the parameter is constant.
struct PathCell {
  std::size_t piece = 0;
  double place = 0, length = 0;       ///< of the parameter, in its piece
  std::vector<double> in, out, bend;  ///< first derivatives at both ends; the second one
};

/// Speeds of the parameter at the ends of cells, from rest to rest.
struct SpeedProfile {
  std::vector<PathCell> cells;
  std::vector<double> squares;  ///< of the speeds, one more than cells
  std::vector<double> times;    ///< at the ends of cells; the last one is endless if there is none

  /// Of the parameter, in a cell.
  [[nodiscard]] double acceleration(std::size_t cell) const {
    return (squares[cell + 1] - squares[cell]) / (2 * cells[cell].length);
  }
};

/// Cells of each piece, shorter at its ends.
std::vector<PathCell> graded_cells(std::span<const PathPiece> pieces);

/// About so many cells that take equally long by a profile; each piece has some of its own.
std::vector<PathCell> even_cells(std::span<const PathPiece> pieces, const SpeedProfile& profile,
                                 std::size_t count);

/// The fastest speeds for which velocities and accelerations are within limits at the ends of each
/// cell, but for rounding: passes backward and forward [pham2018].
/// @param most  squares of speeds at the ends of cells that are not to be exceeded
SpeedProfile fastest_profile(std::vector<PathCell> cells, const std::vector<double>& velocity,
                             const std::vector<double>& acceleration,
                             const std::vector<double>& most);

/// A straight piece with three cells: it speeds up, keeps its speed for at least a time, slows
/// down.
SpeedProfile straight_profile(const PathPiece& piece, const std::vector<double>& velocity,
                              const std::vector<double>& acceleration, double even);

}  // namespace kaboum::motion
