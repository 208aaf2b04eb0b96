// Meshes side by side.

#include <kaboum/picture/panels.h>

#include <kaboum/base/error.h>
#include <kaboum/picture/font.h>
#include <kaboum/picture/render.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace kaboum::picture {
namespace {

constexpr Colour kTitle{0.20F, 0.22F, 0.25F};
constexpr std::pair<const char*, Colour> kColours[] = {{"grey", {0.70F, 0.71F, 0.73F}},
                                                       {"blue", {0.36F, 0.60F, 0.86F}},
                                                       {"orange", {0.95F, 0.61F, 0.28F}},
                                                       {"green", {0.45F, 0.72F, 0.45F}},
                                                       {"red", {0.86F, 0.42F, 0.38F}}};

constexpr std::size_t kMostPixels = 64'000'000;

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidArgument, message);
}

View parse_view(const std::string& text) {
  const std::vector<std::string> parts = split(text);
  double value[2]{};
  bool good = parts.size() == 2;
  for (std::size_t i = 0; good && i < 2; ++i) {
    const char* end = parts[i].data() + parts[i].size();
    const auto [stop, error] = std::from_chars(parts[i].data(), end, value[i]);
    good = error == std::errc() && stop == end && std::abs(value[i]) <= 360;
  }
  if (!good || std::abs(value[1]) > 89) {
    refuse("«view»: give azimuth,elevation in degrees, elevation from -89 to 89, e.g. -50,28");
  }
  return {value[0], value[1]};
}

std::vector<Colour> parse_colours(const std::string& text) {
  std::vector<Colour> result;
  for (const std::string& name : split(text)) {
    const auto* found = std::find_if(std::begin(kColours), std::end(kColours),
                                     [&](const auto& c) { return name == c.first; });
    if (found == std::end(kColours)) {
      refuse("«colours»: '" + name + "' is none of grey, blue, orange, green, red");
    }
    result.push_back(found->second);
  }
  if (result.empty()) refuse("«colours»: at least one is needed");
  return result;
}

Image background(int width, int height) {
  Image image(width, height, Colour{1, 1, 1});
  for (int y = 0; y < height; ++y) {
    const float shade = 1 - 0.07F * static_cast<float>(y) / static_cast<float>(height);
    for (int x = 0; x < width; ++x) image.at(x, y) = {shade, shade, std::min(1.0F, shade + 0.008F)};
  }
  return image;
}

}  // namespace

Image draw_panels(std::span<const geom::Mesh> meshes, const PanelOptions& options) {
  const View view = parse_view(options.view);
  const std::vector<Colour> colours = parse_colours(options.colours);
  const std::vector<std::string> titles = split(options.titles);
  if (meshes.empty()) refuse("there is no mesh to be drawn");
  if (options.width * options.height > kMostPixels)
    refuse("«width» times «height»: more than 64,000,000 pixels");
  if (titles.size() > meshes.size()) refuse("«titles»: more titles than meshes");
  if (options.width < 32 * meshes.size()) refuse("«width»: less than 32 pixels per mesh");
  const int panels = static_cast<int>(meshes.size());
  const int width = static_cast<int>(options.width), height = static_cast<int>(options.height);
  geom::Box3 box;
  for (const geom::Mesh& mesh : meshes) box.extend(geom::bounding_box(mesh));

  Image image = background(width, height);
  const int scale = std::clamp(width / panels / 240, 1, 4);
  const int title_height = titles.empty() ? 0 : 15 * scale;
  const int panel_width = width / panels, panel_height = height - title_height;
  const Camera camera(box, view, panel_width, panel_height);
  for (int i = 0; i < panels; ++i) {
    const auto n = static_cast<std::size_t>(i);
    Style style;
    style.surface = colours[std::min(n, colours.size() - 1)];
    style.edges = options.edges;
    draw_mesh(image, i * panel_width, title_height, panel_width, panel_height, meshes[n], camera,
              style);
    if (n < titles.size()) {
      const int left = i * panel_width + (panel_width - text_width(titles[n], scale)) / 2;
      draw_text(image, titles[n], left, 4 * scale, scale, kTitle);
    }
  }
  return image;
}

}  // namespace kaboum::picture
