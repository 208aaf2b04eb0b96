#pragma once

#include <kaboum/bmesh/decimate.h>

#include <span>
#include <vector>

#include "sampled_error.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// A part of the mesh as it was: the triangles around some vertices, and these.
class RegionSnapshot {
 public:
  /// All references must outlive this object; `steps` may be null.
  RegionSnapshot(WorkingMesh& mesh, SampledError& sampled, DecimateStatistics& statistics,
                 std::vector<Step>* steps);

  void take(std::span<const std::uint32_t> vertices);

  /// Makes the part as it was, and takes back steps.
  /// @pre since `take` only these vertices have moved, and only these triangles
  /// have changed.
  void restore();

  [[nodiscard]] const std::vector<std::uint32_t>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }

 private:
  WorkingMesh& m_;
  SampledError& sampled_;
  DecimateStatistics& statistics_;
  std::vector<Step>* steps_;

  std::vector<std::uint32_t> triangles_, vertices_;
  std::vector<geom::Triangle> corners_;
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> samples_;
  std::size_t step_count_ = 0, pull_backs_ = 0;
  std::vector<std::uint32_t> mark_;  // of triangles
  std::uint32_t mark_value_ = 0;
};

}  // namespace kaboum::bmesh
