#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/io/mesh_io.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "source.h"

namespace kaboum::io {

/// Gives equal positions (−0 = +0) equal numbers, counted from 0 in order of first appearance.
/// Open addressing on the coordinates' bits. Internal to kaboum_io.
class Welder {
 public:
  /// @param expected  number of positions that there is room for from the beginning.
  explicit Welder(std::size_t expected = 0);
  std::uint32_t number_of(const geom::Vec3& position);
  [[nodiscard]] std::vector<geom::Vec3>& points() { return points_; }

 private:
  struct Slot {
    std::uint32_t hash;
    std::uint32_t point;
  };
  void grow();

  std::vector<geom::Vec3> points_;
  std::vector<Slot> slots_;  ///< a power of two
};

/// Collects what a reader finds and makes the result of it: splits polygons, merges vertices, drops
/// collapsed triangles, counts. Faces may come before the points they refer to.
///
/// Every check that does not depend on the format is here. Internal to kaboum_io.
class MeshBuilder {
 public:
  explicit MeshBuilder(const Source& source) : source_(source) {}

  void reserve_points(std::size_t count) { points_.reserve(count); }
  void reserve_triangles(std::size_t count) { triangles_.reserve(count); }

  /// @param where  in the source, for the message about a non-finite coordinate.
  void add_point(const geom::Vec3& point, const char* where);
  void add_triangle(const geom::Triangle& corners) { triangles_.push_back(corners); }
  /// Fewer than three corners are counted and otherwise ignored.
  void add_face(std::span<const std::uint32_t> corners, const char* where);

  /// Takes points that are merged already, `stored` of them before that.
  void adopt_welded_points(std::vector<geom::Vec3>&& points, std::size_t stored);

  /// An index into the points from the file's `index` (counted from `first`), range-checked.
  std::uint32_t corner(std::int64_t index, std::int64_t first, const char* where) const;

  /// Unit of length of the points, which becomes the result's: by its name, or as "0.005 m".
  void set_unit(double metres);

  void note(std::string text) { notes_.push_back(std::move(text)); }
  [[nodiscard]] bool has_faces() const { return !triangles_.empty() || !polygons_.empty(); }
  [[nodiscard]] std::size_t point_count() const { return points_.size(); }
  /// As they were added, where none are welded.
  [[nodiscard]] const std::vector<geom::Vec3>& points() const { return points_; }
  [[nodiscard]] const Source& source() const { return source_; }

  /// @throws Error{InvalidInput} when no triangle is left.
  ReadResult finish(Format format, bool single_precision);

 private:
  struct Polygon {
    std::size_t triangles_before;
    std::size_t first_corner;
    std::size_t corners;
    const char* where;
  };
  void split_polygons(ReadResult& result);
  void weld(ReadResult& result);
  static void note_bends(ReadResult& result);
  void drop_collapsed(ReadResult& result);

  const Source& source_;
  std::vector<geom::Vec3> points_;
  std::vector<geom::Triangle> triangles_;
  std::vector<Polygon> polygons_;
  std::vector<std::uint32_t> polygon_corners_;
  std::size_t stored_points_ = 0;  ///< when welded_
  bool welded_ = false;
  std::size_t tiny_faces_ = 0;
  std::vector<std::string> notes_;
  std::string unit_;
};

}  // namespace kaboum::io
