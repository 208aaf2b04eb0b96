#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::io {

/// How far the corners of a polygon are from one plane: an upper bound of their extent across the
/// plane that fits best, 0 if they are in one plane exactly. Where it is not 0, ways of splitting
/// differ. [length]
double bend_of(std::span<const geom::Vec3> corners);

/// Splits polygons into triangles without adding vertices. Internal to kaboum_io.
///
/// The directed edges of the triangles sum up to the directed edges of the polygon, whatever its
/// shape, so that closed polygon meshes stay closed. Works on the polygon's projection along the
/// dominant axis of its Newell normal with exact orientation tests: the projected triangles do not
/// overlap when the projected polygon is simple, and also when it touches itself (holes connected
/// by a bridge). Triangles without area appear only where no other split exists. Deterministic.
///
/// Time: linear for convex polygons, else corners × those near an ear, cut off by a budget.
class PolygonSplitter {
 public:
  /// @param budget  steps that all calls together may use: corners, and places near them, looked
  ///   at. About 10 to 30 ns each.
  explicit PolygonSplitter(std::uint64_t budget) : budget_(budget) {}

  /// Corners must be finite. Consecutive corners at the same position are taken as one, so fewer
  /// than #corners − 2 triangles may result.
  /// @param triangles  receives indices into `corners`.
  /// @return false when the polygon is not simple (or the budget is used up) and a plain fan around
  ///   its first corner was returned.
  bool split(std::span<const geom::Vec3> corners, std::vector<geom::Triangle>& triangles);
  /// Whether the budget is used up.
  [[nodiscard]] bool exhausted() const { return budget_ == 0; }

 private:
  struct Corner {
    double x, y;               ///< projection, counter-clockwise
    std::uint32_t index;       ///< into the caller's corners
    std::uint32_t prev, next;  ///< in the ring that is left
    bool reflex;               ///< not strictly convex
    bool listed;               ///< in the grid
  };

  bool project(std::span<const geom::Vec3> corners);
  [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  [[nodiscard]] bool same_place(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] int corner_turn(std::uint32_t i) const;
  [[nodiscard]] bool is_convex() const;
  [[nodiscard]] geom::Triangle indices(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  void fan(std::vector<geom::Triangle>& triangles) const;
  bool split_quad(std::vector<geom::Triangle>& triangles) const;
  bool clip_ears(std::vector<geom::Triangle>& triangles);
  std::uint32_t find_ear(std::uint32_t start, std::uint32_t left);
  [[nodiscard]] bool is_ear(std::uint32_t i);
  void update_reflex(std::uint32_t i);
  void spend(std::uint64_t steps) { budget_ -= steps < budget_ ? steps : budget_; }

  /// Reflex corners, which may lie in an ear, by the cell of a grid that they are in. Corners that
  /// have become convex, or were cut off, leave it when they are met.
  struct Grid {
    double x, y, per_x, per_y;  ///< its lowest corner; cells per length
    std::uint32_t columns, rows;
    std::vector<std::uint32_t> first, next;  ///< per cell; per corner

    [[nodiscard]] std::uint32_t column(double at) const;
    [[nodiscard]] std::uint32_t row(double at) const;
  };
  void make_grid();
  void add_to_grid(std::uint32_t i);

  std::uint64_t budget_;
  std::vector<Corner> ring_;
  Grid grid_{};
};

}  // namespace kaboum::io
