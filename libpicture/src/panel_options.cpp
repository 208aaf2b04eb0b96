// The options of a picture: their table.

#include <kaboum/picture/panels.h>

namespace kaboum::picture {

const std::vector<Option<PanelOptions>>& panel_options() {
  using R = PanelOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "width",
           .text = "Width of the picture, pixels",
           .values = "PIXELS",
           .low = 32,
           .high = 16384},
          [](auto& r) -> auto& { return r.width; }),
      option<R>(
          {.name = "height",
           .text = "Height of the picture, pixels",
           .values = "PIXELS",
           .low = 32,
           .high = 16384},
          [](auto& r) -> auto& { return r.height; }),
      option<R>(
          {.name = "titles",
           .text = "Titles of the panels, separated by commas",
           .values = "TEXT,TEXT,...",
           .otherwise = "none"},
          [](auto& r) -> auto& { return r.titles; }),
      option<R>(
          {.name = "view",
           .text = "Camera: azimuth,elevation in degrees",
           .values = "DEGREES,DEGREES"},
          [](auto& r) -> auto& { return r.view; }),
      option<R>(
          {.name = "colours",
           .text = "Colours of the panels: grey, blue, orange, green, red; the last one repeats",
           .values = "NAME,NAME,..."},
          [](auto& r) -> auto& { return r.colours; }),
      option<R>(
          {.name = "edges", .text = "Draw every edge, not only sharp ones and borders"},
          [](auto& r) -> auto& { return r.edges; })};
  return options;
}

}  // namespace kaboum::picture
