#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "builder.h"
#include "placement.h"

namespace kaboum::io {

/// Rotation by `angle`, in radians; the axis need not be of unit length, and 0 is no rotation.
Eigen::Matrix3d rotation(const geom::Vec3& axis, double angle);

/// Copies a scene's meshes, moved to their places, into a builder. Internal to kaboum_io.
class SceneCopier {
 public:
  explicit SceneCopier(MeshBuilder& builder);

  /// Adds the points of a mesh; the faces that follow refer to them.
  /// @throws Error{LimitReached} when instances multiply out of proportion to the file.
  void add_points(std::span<const geom::Vec3> points, const Placement& placement,
                  const char* where);
  /// Corners count from the first of the latest points and are in range. Reversed by a placement
  /// that mirrors.
  void add_face(std::span<const std::uint32_t> corners, const char* where);

  /// Counts a node of the scene, so that nested references to empty nodes end, too.
  void visit() { spend(16); }

  /// Counts work that references can repeat; copying a point is 1.
  void spend(std::uint64_t count);
  /// Counts text that is read each time it is referred to.
  void spend(std::string_view text) { spend(text.size() / 8); }

  /// Bytes of further files that belong to the scene.
  void allow(std::size_t bytes) { budget_ += 64 * std::uint64_t{bytes}; }

  /// Says what placements did.
  void add_notes() const;

 private:
  MeshBuilder& builder_;
  std::uint64_t budget_;
  std::size_t first_ = 0;  ///< of the latest points
  bool mirrors_ = false;   ///< the latest placement
  bool placed_ = false;
  bool mirrored_ = false;
  std::vector<std::uint32_t> corners_;
};

}  // namespace kaboum::io
