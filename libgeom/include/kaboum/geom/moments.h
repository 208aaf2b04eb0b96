#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/solid_mesh.h>
#include <kaboum/geom/transform.h>

#include <array>
#include <memory>

namespace kaboum::geom {

/// Two numbers that one which is not known exactly lies between.
struct Bounds {
  double lower = 0, upper = 0;
};

/// Mass, centre of mass and inertia about it.
template <class Number>
struct MassOf {
  Number mass = {};
  std::array<Number, 3> centre = {};   ///< [length]
  std::array<Number, 6> inertia = {};  ///< xx, yy, zz, xy, xz, yz; −∫ x y off the diagonal
};

/// What is known of a solid's mass.
struct MassProperties {
  MassOf<Bounds> bounds;
  /// Numbers within the bounds, in their middle if a body can have those.
  MassOf<double> value;
  bool is_of_body = true;  ///< a body can have `value`; else the bounds are too wide to find one
};

/// Integrals over a solid of 1, of the coordinates and of their products: rational numbers that the
/// integrals lie between, mostly equal ones. Nothing is rounded before MassProperties.
/// docs/algorithms/inertia.md.
class Moments {
 public:
  Moments();  ///< of nothing

  static Moments of_box(const Vec3& edges);       ///< about its middle
  static Moments of_ellipsoid(const Vec3& half);  ///< about its middle
  /// About its middle, along z. @param length  of a capsule that of the segment it is round
  static Moments of_cylinder(double radius, double length);
  static Moments of_capsule(double radius, double length);

  /// Of the solid stretched along the axes, also mirrored.
  [[nodiscard]] Moments scaled(const Vec3& factors) const;
  /// Of the solid moved by a pose whose rotation is rounded: each entry is within 2^-46.
  [[nodiscard]] Moments moved(const Transform& pose) const;

  /// Of both solids together. What they may have in common is up to `note_overlap`.
  Moments& operator+=(const Moments& other);
  /// Two solids that are in these moments may have points of the box in common, which count once.
  /// Boxes without volume say nothing.
  void note_overlap(const Box3& box);
  /// True if something is not known exactly: note_overlap was told of a volume, or as moments_of
  /// says.
  [[nodiscard]] bool overlaps() const;
  /// True if the solid has a volume for sure.
  [[nodiscard]] bool has_volume() const;

  /// @pre has_volume(), a positive number
  [[nodiscard]] MassProperties with_density(double density) const;
  [[nodiscard]] MassProperties with_mass(double mass) const;

 private:
  friend Moments moments_of(const SolidMesh& solid);
  struct Numbers;
  std::shared_ptr<const Numbers> numbers_;
};

/// Moments of the solid of a prepared mesh. They are exact where each triangle either is a border
/// between inside and outside or is none, all over. Triangles that others cross may be in part:
/// what they may have makes the bounds wider.
/// @throws Error{InvalidInput}: it is open, or has holes that were filled
Moments moments_of(const SolidMesh& solid);

}  // namespace kaboum::geom
