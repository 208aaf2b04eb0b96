// Renders meshes side by side into a PNG.
#include "common/cli.h"
#include "font.h"
#include "png_file.h"
#include "render.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/io/convex_io.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <sstream>

namespace {

using namespace kaboum;
using namespace kaboum::picture;

struct Options {
  std::vector<std::string> inputs;
  std::string output, titles, view = "-50,28", colours = "grey,blue,orange", input_format;
  int width = 1500, height = 620;
  bool edges = false;
};

constexpr Colour kInk{0.20F, 0.22F, 0.25F};
constexpr std::pair<const char*, Colour> kColours[] = {{"grey", {0.70F, 0.71F, 0.73F}},
                                                       {"blue", {0.36F, 0.60F, 0.86F}},
                                                       {"orange", {0.95F, 0.61F, 0.28F}},
                                                       {"green", {0.45F, 0.72F, 0.45F}},
                                                       {"red", {0.86F, 0.42F, 0.38F}}};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

[[noreturn]] void usage(const std::string& message) {
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
    usage("--view: give azimuth,elevation in degrees, elevation from -89 to 89, e.g. -50,28");
  }
  return {value[0], value[1]};
}

std::vector<Colour> parse_colours(const std::string& text) {
  std::vector<Colour> result;
  for (const std::string& name : split(text)) {
    const auto* found = std::find_if(std::begin(kColours), std::end(kColours),
                                     [&](const auto& c) { return name == c.first; });
    if (found == std::end(kColours)) {
      usage("--colours: '" + name + "' is none of grey, blue, orange, green, red");
    }
    result.push_back(found->second);
  }
  if (result.empty()) usage("--colours: at least one is needed");
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

/// A mesh, or the bodies of a set.
geom::Mesh read(const std::string& input, io::Format format) {
  if (format != io::Format::Glb) return io::read_mesh(input, format).mesh;
  geom::Mesh sum;
  for (const geom::ConvexBody& body : io::read_convex_set(input, format).bodies) {
    const auto first = static_cast<std::uint32_t>(sum.vertices.size());
    const geom::Mesh surface = geom::surface_of(body);
    sum.vertices.insert(sum.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const geom::Triangle& t : surface.triangles)
      sum.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return sum;
}

int make_picture(const Options& options) {
  tools::require_apart({{"--output", options.output}}, options.inputs);
  const View view = parse_view(options.view);
  const std::vector<Colour> colours = parse_colours(options.colours);
  const std::vector<std::string> titles = split(options.titles);
  if (titles.size() > options.inputs.size()) usage("--titles: more titles than meshes");
  const int panels = static_cast<int>(options.inputs.size());
  if (options.width < 32 * panels) usage("--width: less than 32 pixels per mesh");

  std::vector<geom::Mesh> meshes;
  geom::Box3 box;
  for (const std::string& input : options.inputs) {
    const io::Format format = tools::format_for(input, options.input_format, "--input-format");
    meshes.push_back(read(input, format));
    box.extend(geom::bounding_box(meshes.back()));
  }

  Image image = background(options.width, options.height);
  const int scale = std::clamp(options.width / panels / 240, 1, 4);
  const int title_height = titles.empty() ? 0 : 15 * scale;
  const int panel_width = options.width / panels, panel_height = options.height - title_height;
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
      draw_text(image, titles[n], left, 4 * scale, scale, kInk);
    }
  }
  io::write_file(options.output, encode_png(image));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Renders meshes side by side into a PNG; one camera for all.", "mesh-picture"};
  Options options;
  app.add_option("meshes", options.inputs, "Mesh files, or -")->required()->type_name("FILE");
  app.add_option("-o,--output", options.output, "PNG file to write; - is standard output")
      ->required()
      ->check(tools::png_name())
      ->type_name("FILE");
  app.add_option("--width", options.width, "Width of the picture, pixels")
      ->check(CLI::Range(32, 16384))
      ->capture_default_str();
  app.add_option("--height", options.height, "Height of the picture, pixels")
      ->check(CLI::Range(32, 16384))
      ->capture_default_str();
  app.add_option("--titles", options.titles, "Titles of the panels, separated by commas");
  app.add_option("--view", options.view, "Camera: azimuth,elevation in degrees")
      ->capture_default_str();
  app.add_option("--colours,--colors", options.colours,
                 "Colours of the panels: grey, blue, orange, green, red; the last one repeats")
      ->capture_default_str();
  app.add_flag("--edges", options.edges, "Draw every edge, not only sharp ones and borders");
  app.add_option("--input-format", options.input_format, "Format, when extensions do not tell");
  return tools::run(app, argc, argv, [&] { return make_picture(options); });
}
