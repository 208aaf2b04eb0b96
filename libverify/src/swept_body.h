#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace kaboum::verify {

/// A convex body with bounds of distances to it, safe in double arithmetic.
class SweptBody {
 public:
  /// @pre exactly convex, outward normals (verify_convexity)
  explicit SweptBody(const geom::Mesh& hull);

  /// Whether the point is certainly within `distance` of the body; with a negative distance,
  /// whether it is certainly that deep inside. Points near the limit may get "no".
  [[nodiscard]] bool holds(const geom::Vec3& p, double distance) const;
  /// Whether a facet's plane shows that the point is farther than that from the body.
  [[nodiscard]] bool is_beyond(const geom::Vec3& p, double distance) const;
  /// Not less than the distance of the point from the body.
  [[nodiscard]] double distance_from_above(const geom::Vec3& p) const;
  /// Not more than it.
  [[nodiscard]] double distance_from_below(const geom::Vec3& p) const;
  /// Not more than it, quickly.
  [[nodiscard]] double distance_to_box(const geom::Vec3& p) const {
    return (p - p.cwiseMax(box_.min).cwiseMin(box_.max)).norm() * (1 - 0x1p-40);
  }
  [[nodiscard]] const geom::Box3& box() const { return box_; }

 private:
  struct Facet {
    geom::Vec3 a, b, c;
    geom::Vec3 normal = geom::Vec3::Zero();
    double offset = 0;
    /// Times the largest coordinate: what rounding does to normal · p − offset. Without bound until
    /// the plane is known.
    double slack = std::numeric_limits<double>::infinity();
  };
  using Pair = double __attribute__((vector_size(16)));
  /// The planes of two facets; an odd number's last facet twice.
  struct Planes {
    Pair x, y, z, offset, slack;
  };
  /// What is the same for all planes of a body.
  struct Place {
    Pair x, y, z, size;
  };
  static void set_plane(Facet& f);
  [[nodiscard]] Place place(const geom::Vec3& p) const;
  static Pair height(const Planes& planes, const Place& at);
  /// All planes are above the point by more than rounding.
  [[nodiscard]] bool is_inside(const Place& at) const;
  [[nodiscard]] double rounding(const geom::Vec3& p) const;
  /// The point of the facets that seems nearest; certainly one of the body, but for rounding.
  [[nodiscard]] geom::Vec3 nearest(const geom::Vec3& p) const;

  std::vector<Facet> facets_;
  std::vector<Planes> planes_;
  std::vector<geom::Vec3> vertices_;
  geom::Box3 box_;
  double size_ = 0;  // largest coordinate
};

}  // namespace kaboum::verify
