// Surfaces coloured by their distances, from where the largest one is seen.

#include <kaboum/picture/heatmap.h>

#include <kaboum/picture/font.h>
#include <kaboum/picture/render.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>

namespace kaboum::picture {
namespace {

// The colour map "viridis" (S. van der Walt, N. Smith, 2015; CC0), every eighth of the way.
constexpr std::array<Colour, 9> kStops{{{0.267F, 0.005F, 0.329F},
                                        {0.279F, 0.175F, 0.483F},
                                        {0.230F, 0.322F, 0.546F},
                                        {0.173F, 0.449F, 0.558F},
                                        {0.128F, 0.567F, 0.551F},
                                        {0.158F, 0.684F, 0.502F},
                                        {0.369F, 0.789F, 0.383F},
                                        {0.678F, 0.864F, 0.190F},
                                        {0.993F, 0.906F, 0.144F}}};
constexpr Colour kInk{0.20F, 0.22F, 0.25F};

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

double share(double value, double largest) { return largest > 0 ? value / largest : 0; }

/// The first view that shows the point: the usual one, then others round the object.
struct Sight {
  View view;
  bool turned = false;
  bool visible = false;
};

Sight sight_of(const geom::Vec3& point, const geom::Mesh& mesh, const geom::Box3& box, int width,
               int height) {
  constexpr double kSlack = 1e-3;
  Sight sight;
  for (const double elevation : {28.0, -28.0, 80.0, -80.0}) {
    for (int turn = 0; turn < 360; turn += 45) {
      const View view{View{}.azimuth + turn, elevation};
      if (!sees(Camera(box, view, width, height), mesh, point, kSlack)) continue;
      return {view, turn != 0 || elevation != View{}.elevation, true};
    }
  }
  return sight;
}

/// A ring round (x, y), white within dark so that it is seen on every colour.
void draw_ring(Image& image, int x, int y, int radius, int thickness, bool dashed) {
  const int extent = radius + 2 * thickness;
  for (int i = -extent; i <= extent; ++i) {
    for (int j = -extent; j <= extent; ++j) {
      if (x + i < 0 || y + j < 0 || x + i >= image.width || y + j >= image.height) continue;
      const double off = std::hypot(i, j) - radius;
      if (std::abs(off) > thickness) continue;
      if (dashed && static_cast<int>(std::floor(std::atan2(j, i) * 4)) % 2 != 0) continue;
      image.at(x + i, y + j) = std::abs(off) < 0.5 * thickness ? Colour{1, 1, 1} : kInk;
    }
  }
}

}  // namespace

Colour heat(double value) {
  const double at = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const auto f = static_cast<float>(at - static_cast<double>(i));
  Colour result{};
  for (std::size_t k = 0; k < 3; ++k) result[k] = (1 - f) * kStops[i][k] + f * kStops[i + 1][k];
  return result;
}

Image draw_heatmap(const std::vector<HeatPanel>& panels, double largest, double diagonal, int width,
                   int height) {
  Image image(width, height, Colour{1, 1, 1});
  const int columns = static_cast<int>(panels.size());
  const int scale = std::clamp(width / columns / 300, 1, 4);
  const int title = 15 * scale, legend = 40 * scale;
  const int panel_width = width / columns, panel_height = height - title - legend;
  geom::Box3 box;
  for (const HeatPanel& p : panels) box.extend(geom::bounding_box(*p.mesh));
  for (int i = 0; i < columns; ++i) {
    const HeatPanel& panel = panels[static_cast<std::size_t>(i)];
    const Sight sight = sight_of(panel.maximum, *panel.mesh, box, panel_width, panel_height);
    const Camera camera(box, sight.view, panel_width, panel_height);
    std::vector<Colour> colours;
    colours.reserve(panel.values->size());
    for (const double v : *panel.values) colours.push_back(heat(share(v, largest)));
    Style style;
    style.outlines = false;
    style.vertex_colours = colours;
    draw_mesh(image, i * panel_width, title, panel_width, panel_height, *panel.mesh, camera, style);
    const geom::Vec3 at = camera.project(panel.maximum);
    draw_ring(image, i * panel_width + static_cast<int>(at.x()), title + static_cast<int>(at.y()),
              7 * scale, 2 * scale, !sight.visible);
    const std::string text = panel.title + (sight.turned    ? " (turned to the maximum)"
                                            : sight.visible ? ""
                                                            : " (maximum hidden: dashed)");
    draw_text(image, text, i * panel_width + (panel_width - text_width(text, scale)) / 2, 4 * scale,
              scale, kInk);
  }
  // The scale: a bar, and lengths below it.
  const int left = width / 8, bar = width - 2 * left, top = height - legend + 4 * scale;
  for (int x = 0; x < bar; ++x)
    for (int y = 0; y < 12 * scale; ++y)
      image.at(left + x, top + y) = heat(x / std::max(1.0, bar - 1.0));
  constexpr int kTicks = 4;
  for (int i = 0; i <= kTicks; ++i) {
    const double value = largest * i / kTicks;
    std::string text = number(value);
    if (diagonal > 0) text += " (" + number(100 * value / diagonal) + "%)";
    const int x = left + bar * i / kTicks;
    draw_text(image, text, x - text_width(text, scale) / 2, top + 17 * scale, scale, kInk);
  }
  return image;
}

std::vector<char> heatmap_ply(const geom::Mesh& mesh, const std::vector<double>& values,
                              double largest) {
  std::string out =
      "ply\nformat binary_little_endian 1.0\n"
      "comment colour and quality: distance to the other surface\n"
      "element vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty double quality\n"
      "element face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar uint vertex_indices\nend_header\n";
  std::vector<char> bytes(out.begin(), out.end());
  const auto put = [&](std::uint64_t bits, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>((bits >> (8 * i)) & 0xffU));
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int k = 0; k < 3; ++k) put(std::bit_cast<std::uint64_t>(mesh.vertices[v][k]), 8);
    for (const float c : heat(share(values[v], largest)))
      put(static_cast<std::uint64_t>(std::lround(255 * c)), 1);
    put(std::bit_cast<std::uint64_t>(values[v]), 8);
  }
  for (const geom::Triangle& t : mesh.triangles) {
    put(3, 1);
    for (const std::uint32_t v : t) put(v, 4);
  }
  return bytes;
}

}  // namespace kaboum::picture
