// Two meshes side by side as the bytes of a PNG.

#include <kaboum/picture/panels.h>
#include <kaboum/picture/png_file.h>

#include <array>
#include <iostream>

#include "sphere.h"

int main() {
  const std::array<kaboum::geom::Mesh, 2> meshes{sphere(24, 12), sphere(8, 4)};
  kaboum::picture::PanelOptions options;
  options.titles = "fine,coarse";
  const std::vector<char> png =
      kaboum::picture::encode_png(kaboum::picture::draw_panels(meshes, options));
  std::cout << "a picture of " << png.size() << " bytes\n";
  return png.empty() ? 1 : 0;
}
