#pragma once

#include <kaboum/geom/transform.h>

#include <optional>
#include <vector>

namespace kaboum::collide {

/// Vertices of a convex body, coordinate by coordinate, for the processor's sake.
class SupportPoints {
 public:
  /// @pre the mesh has a vertex.
  explicit SupportPoints(const geom::Mesh& mesh);

  /// Mean of the vertices.
  [[nodiscard]] const geom::Vec3& center() const { return center_; }

  /// The vertex farthest along d, the first of several.
  [[nodiscard]] geom::Vec3 support(const geom::Vec3& d) const;

 private:
  std::vector<double> x_, y_, z_;
  geom::Vec3 center_ = geom::Vec3::Zero();
};

/// A direction d along which two bodies are apart, every point p of a and q of pose · b having
/// p · d < q · d in rounded arithmetic; nullopt when eight steps find none, which says nothing.
/// Starts at the vector between the centres and mirrors it at the vector between the supporting
/// points (K. Chung, W. Wang: Quick collision detection of polytopes in virtual environments,
/// 1996).
/// @param pose  takes b into the frame of a; a rotation.
std::optional<geom::Vec3> find_separating_direction(const SupportPoints& a, const SupportPoints& b,
                                                    const geom::Transform& pose);

}  // namespace kaboum::collide
