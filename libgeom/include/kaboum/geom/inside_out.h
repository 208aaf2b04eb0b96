#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <optional>
#include <string>

namespace kaboum::geom {

/// Parts of a mesh that enclose nothing because it is oriented inwards.
struct InsideOut {
  std::size_t parts = 0;       ///< that preparing turns; 0: none
  std::uint32_t triangle = 0;  ///< of the first
  Vec3 at = Vec3::Zero();      ///< its middle
  std::optional<Vec3> hollow;  ///< where no part is turned: PreparationReport::hollow
  std::string refusal;         ///< why nothing is known of it: it cannot be prepared; or empty
};

/// The closed parts of a mesh that preparing would turn, what stays hollow, or why that cannot be
/// told.
std::optional<InsideOut> find_inside_out(const Mesh& mesh);

/// A sentence about it, without its full stop.
std::string text_of(const InsideOut& found);

}  // namespace kaboum::geom
