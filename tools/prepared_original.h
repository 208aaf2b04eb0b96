#pragma once

#include <kaboum/geom/prepare.h>

#include <optional>
#include <string>

namespace kaboum::tools {

/// A mesh as bmesh-decimate and bcd-decompose prepare it: what they claim is about that.
/// @param fill  fill its holes, as both do by default.
/// @throws Error{InvalidInput} as geom::prepare.
geom::Prepared prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool fill);

/// What of a mesh as it is encloses nothing because it is oriented inwards.
struct InsideOut {
  std::size_t parts = 0;               ///< that preparing turns; 0: none
  std::uint32_t triangle = 0;          ///< of the first
  geom::Vec3 at = geom::Vec3::Zero();  ///< its middle
  std::optional<geom::Vec3> hollow;    ///< where no part is turned: geom::PreparationReport::hollow
  std::string refusal;  ///< why nothing is known of it: it cannot be prepared; or empty
};

/// The closed parts of a mesh that preparing would turn, what stays hollow, or why that cannot be
/// told.
std::optional<InsideOut> find_inside_out(const geom::Mesh& mesh);

/// What is said of it.
std::string text_of(const InsideOut& found);

}  // namespace kaboum::tools
