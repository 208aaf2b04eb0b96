#pragma once

#include <kaboum/picture/image.h>

#include <kaboum/geom/mesh.h>

#include <string>
#include <vector>

namespace kaboum::picture {

/// Colour of a value in [0, 1]: dark violet over green to yellow, brighter throughout (viridis).
Colour heat(double value);

/// A mesh with a value at each vertex.
struct HeatPanel {
  const geom::Mesh* mesh;
  const std::vector<double>* values;
  std::string title;
  geom::Vec3 maximum;  ///< where the largest value is, on the mesh; marked by a ring
};

/// Meshes side by side, coloured from 0 to `largest`, above a scale with lengths and percentages of
/// `diagonal`. All are seen from one side unless that hides a maximum: its panel is turned, and
/// says so; where no side shows it, the ring is dashed.
Image draw_heatmap(const std::vector<HeatPanel>& panels, double largest, double diagonal, int width,
                   int height);

/// Binary PLY with doubles, the colours, and the value of each vertex as `quality`.
std::vector<char> heatmap_ply(const geom::Mesh& mesh, const std::vector<double>& values,
                              double largest);

}  // namespace kaboum::picture
