#pragma once

#include <kaboum/geom/mesh.h>

#include <optional>
#include <span>
#include <vector>

#include "principal_box.h"

namespace kaboum::bcd {

/// A prism round points: the box along the axes of their covariance, or one with a side on a facet
/// of their hull and another along an edge of its outline, whichever is smallest. It has 8, 16, 32
/// or 64 sides instead of four where those make its base smaller by a fiftieth.
class PrincipalPrism {
 public:
  /// @param most  vertices; at least 8.
  /// @return nullopt without points, or when their covariance overflows.
  static std::optional<PrincipalPrism> round(std::span<const geom::Vec3> points, std::size_t most);

  /// Of the prism with every side moved outwards by `margin`.
  [[nodiscard]] std::vector<geom::Vec3> corners(double margin = 0) const;

 private:
  PrincipalPrism(std::span<const geom::Vec3> points, const PrincipalBox& box, std::size_t most);
  [[nodiscard]] double volume() const;

  PrincipalBox box_;
  std::vector<double> heights_;  // of the sides, whose normals are evenly spaced from axis 1 on
};

}  // namespace kaboum::bcd
