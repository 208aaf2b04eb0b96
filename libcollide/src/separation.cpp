// Directions along which two convex bodies are apart: cheaper than any distance, and enough for
// most pairs whose boxes meet.

#include <kaboum/collide/separation.h>

#include <limits>

namespace kaboum::collide {

SupportPoints::SupportPoints(const geom::Mesh& mesh) {
  for (const geom::Vec3& v : mesh.vertices)
    center_ += v / static_cast<double>(mesh.vertices.size());
  for (const geom::Vec3& v : mesh.vertices) {
    x_.push_back(v.x());
    y_.push_back(v.y());
    z_.push_back(v.z());
  }
}

geom::Vec3 SupportPoints::support(const geom::Vec3& d) const {
  std::size_t best = 0;
  double farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double along = d.x() * x_[i] + d.y() * y_[i] + d.z() * z_[i];
    best = along > farthest ? i : best;
    farthest = along > farthest ? along : farthest;
  }
  return {x_[best], y_[best], z_[best]};
}

std::optional<geom::Vec3> find_separating_direction(const SupportPoints& a, const SupportPoints& b,
                                                    const geom::Transform& pose) {
  geom::Vec3 direction = pose * b.center() - a.center();
  for (int step = 0; step < 8; ++step) {
    const geom::Vec3 p = a.support(direction);
    const geom::Vec3 q = pose * b.support(-(pose.linear.transpose() * direction));
    const geom::Vec3 between = q - p;
    const double gap = between.dot(direction);
    if (gap > 0) return direction;
    direction -= 2 * gap / between.squaredNorm() * between;
    if (!direction.allFinite()) break;
  }
  return std::nullopt;
}

}  // namespace kaboum::collide
