#pragma once

#include <kaboum/geom/mesh.h>

#include <optional>
#include <span>

namespace kaboum::geom {

/// The solid that B bounds, for distances that are 0 inside it.
class Interior {
 public:
  Interior() = default;
  Interior(const Interior&) = delete;
  Interior& operator=(const Interior&) = delete;
  virtual ~Interior() = default;

  /// Decides whether p lies in the solid: exactly, or nullopt. Safe to call from several
  /// threads, as all of these.
  ///
  /// @param free  lower bound of p's distance to the triangles of B, if one is known: within it
  ///   nothing changes, which helps where p lies on a fold inside the solid.
  [[nodiscard]] virtual std::optional<bool> contains(const Vec3& p, double free) const = 0;

  /// True if the ball is certainly part of the solid, given a lower bound of its centre's distance
  /// to the triangles of B.
  [[nodiscard]] virtual bool covers_ball(const Vec3& center, double radius,
                                         double distance) const = 0;

  /// True if every point of the convex hull of the corners is certainly within `slack` of the
  /// solid. May say no where it is hard to tell.
  [[nodiscard]] virtual bool covers(std::span<const Vec3> corners, double slack) const = 0;
};

}  // namespace kaboum::geom
