// Scenes: where their meshes are placed, and how often.

#include "scene_copier.h"

#include <kaboum/base/error.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace kaboum::io {

Eigen::Matrix3d rotation(const geom::Vec3& axis, double angle) {
  const double length = axis.stableNorm();
  if (angle == 0 || length == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, axis / length).toRotationMatrix();
}

SceneCopier::SceneCopier(MeshBuilder& builder)
    : builder_(builder), budget_(1'000'000 + 64 * std::uint64_t{builder.source().bytes.size()}) {}

void SceneCopier::add_points(std::span<const geom::Vec3> points, const Placement& placement,
                             const char* where) {
  spend(points.size());
  first_ = builder_.point_count();
  const bool identity = placement.is_identity();
  for (const geom::Vec3& p : points) builder_.add_point(identity ? p : placement * p, where);
  mirrors_ = placement.mirrors();
  mirrored_ |= mirrors_;
  placed_ |= !identity;
}

void SceneCopier::add_face(std::span<const std::uint32_t> corners, const char* where) {
  spend(1 + corners.size() / 4);
  corners_.clear();
  for (const std::uint32_t corner : corners)
    corners_.push_back(static_cast<std::uint32_t>(first_ + corner));
  if (mirrors_) std::ranges::reverse(corners_);
  builder_.add_face(corners_, where);
}

void SceneCopier::spend(std::uint64_t count) {
  if (count > budget_)
    throw Error(ErrorCode::LimitReached,
                std::string(builder_.source().name) +
                    ": instances repeat too much; expand or simplify the scene");
  budget_ -= count;
}

void SceneCopier::add_notes() const {
  if (placed_)
    builder_.note(
        "Coordinates are the file's, moved by its transforms in rounded double precision.");
  if (mirrored_)
    builder_.note("Transforms with negative determinant mirror meshes; their faces were reversed.");
}

}  // namespace kaboum::io
