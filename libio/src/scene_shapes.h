#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "scene_fields.h"

namespace kaboum::io {

/// Reads the surfaces in the Shape nodes of one file. Internal to kaboum_io.
class ShapeReader {
 public:
  /// @param anchor  for an inlined file, the place of its Inline in the outermost file.
  /// @param lines   counts nodes with lines or points only.
  ShapeReader(const SceneFields& fields, SceneCopier& copier, const char* anchor,
              std::size_t& lines)
      : fields_(fields), copier_(copier), anchor_(anchor), lines_(lines) {}

  void read_shape(const SceneNode& node, const Placement& placement);

  /// A place that outlives this reader, for the builder, which knows the outermost file only.
  [[nodiscard]] const char* outermost(const char* where) const {
    return anchor_ != nullptr ? anchor_ : where;
  }

 private:
  /// How the corners of one run make faces.
  enum class Run { Polygon, Strip, Fan };

  void read_geometry(const SceneNode& node, const Placement& placement);

  void read_box(const SceneNode& node, const Placement& placement);

  void read_points(const SceneNode& node);

  void read_faces(const SceneNode& node, const SceneField* index, bool reversed);

  /// @param size  corners of a face; 0: faces end at an index of -1.
  void read_indices(const SceneField& index, std::size_t size, Run run, bool reversed);

  /// Makes faces of corners_, and clears it.
  void add_run(Run run, bool reversed, const char* where);

  const SceneFields& fields_;
  SceneCopier& copier_;
  const char* anchor_;
  std::size_t& lines_;
  std::vector<geom::Vec3> points_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace kaboum::io
