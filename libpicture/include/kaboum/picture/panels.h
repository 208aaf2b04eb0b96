#pragma once

#include <kaboum/base/option.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/picture/image.h>

#include <span>
#include <string>
#include <vector>

namespace kaboum::picture {

/// How meshes are drawn side by side.
struct PanelOptions {
  std::size_t width = 1500, height = 620;    ///< of the whole picture, pixels
  std::string titles;                        ///< of the panels, with commas between them
  std::string view = "-50,28";               ///< azimuth and elevation, degrees
  std::string colours = "grey,blue,orange";  ///< of the panels; the last one repeats
  bool edges = false;                        ///< every edge, not only sharp ones and borders
};

/// The options of a picture.
const std::vector<Option<PanelOptions>>& panel_options();

/// Meshes side by side, one camera for all.
/// @throws Error{InvalidArgument} naming the option: no view, an unknown colour, more titles than
///   meshes, less than 32 pixels per mesh, too many pixels; where there is no mesh;
///   Error{InvalidInput} for coordinates that are not finite or beyond 1e60
Image draw_panels(std::span<const geom::Mesh> meshes, const PanelOptions& options = {});

}  // namespace kaboum::picture
