// Two shapes coloured by their distances, as a picture, a page or a mesh.

#include <kaboum/page/distance_page.h>

#include <kaboum/base/error.h>
#include <kaboum/page/preview.h>
#include <kaboum/picture/heatmap.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/picture/refine.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace kaboum::page {
namespace {

using distance::Comparison;

constexpr int kWidth = 1600, kHeight = 800;
constexpr double kMostCuts = 50000;  ///< triangles of a page that come of cutting larger ones

std::string extension_of(const std::string& file) {
  return std::filesystem::path(file).extension().string();
}

std::string interval(const distance::OneWay& way, double diagonal) {
  std::ostringstream out;
  out.precision(4);
  out << "at most " << way.max.max_upper << ", at least " << way.max.max_lower << ", certified";
  if (diagonal > 0)
    out << " (at most " << 100 * way.max.max_upper / diagonal << "% of the diagonal)";
  return out.str();
}

std::string page_of(const HeatmapOf& shapes) {
  const auto& [comparison, result, names, solid] = shapes;
  Preview preview{"Distances"};
  preview.meaning = solid ? "distance from the other solid" : "distance from the other surface";
  for (const auto side : {Comparison::A, Comparison::B}) {
    const std::string name = side == Comparison::A ? "A" : "B";
    preview.facts.emplace_back(name, names[side]);
    Layer& layer = preview.layers.emplace_back();
    layer.name = name;
    layer.all_edges = true;
    layer.view = side == Comparison::A ? Layer::View::Shown : Layer::View::Transparent;
    Shape& shape = layer.shapes.emplace_back();
    shape.mesh = picture::refined(comparison.surface(side), comparison.diagonal() / 100, kMostCuts);
    shape.distances =
        comparison.distances(shape.mesh, side == Comparison::A ? Comparison::B : Comparison::A);
  }
  preview.facts.emplace_back("from A to B", interval(result.a_to_b, comparison.diagonal()));
  preview.facts.emplace_back("from B to A", interval(result.b_to_a, comparison.diagonal()));
  return preview_page(preview);
}

}  // namespace

bool is_heatmap(const std::string& file) {
  constexpr std::array<const char*, 3> kExtensions{".png", ".html", ".ply"};
  return std::ranges::find(kExtensions, extension_of(file)) != kExtensions.end();
}

std::vector<char> heatmap(const std::string& file, const HeatmapOf& shapes) {
  if (!is_heatmap(file))
    throw Error(ErrorCode::InvalidArgument, "give a .png, .html or .ply file, not " + file);
  if (extension_of(file) == ".html") {
    const std::string page = page_of(shapes);
    return {page.begin(), page.end()};
  }
  const Comparison& c = shapes.comparison;
  const distance::Compared& result = shapes.result;
  const double part = c.diagonal() / 100;
  geom::Mesh a = picture::refined(c.surface(Comparison::A), part);
  const std::vector<double> to_b = c.distances(a, Comparison::B);
  if (extension_of(file) == ".ply") {
    for (geom::Vec3& v : a.vertices) v += c.origin();
    return picture::heatmap_ply(a, to_b, result.a_to_b.max.max_upper);
  }
  const geom::Mesh b = picture::refined(c.surface(Comparison::B), part);
  const std::vector<double> to_a = c.distances(b, Comparison::A);
  return picture::encode_png(
      picture::draw_heatmap({{&a, &to_b, "A: distance to B", result.a_to_b.max.at - c.origin()},
                             {&b, &to_a, "B: distance to A", result.b_to_a.max.at - c.origin()}},
                            result.upper(), c.diagonal(), kWidth, kHeight));
}

}  // namespace kaboum::page
