// What hausdorff-eval shows on a page.

#include "hausdorff_page.h"

#include <filesystem>
#include <sstream>

#include "picture/refine.h"
#include "player/preview.h"

namespace kaboum::tools {
namespace {

using distance::Comparison;

constexpr double kMostCuts = 50000;  ///< triangles that come of cutting larger ones, of each

std::string interval(const distance::OneWay& way, double diagonal) {
  std::ostringstream out;
  out.precision(4);
  out << "at most " << way.max.max_upper << ", at least " << way.max.max_lower << ", certified";
  if (diagonal > 0)
    out << " (at most " << 100 * way.max.max_upper / diagonal << "% of the diagonal)";
  return out.str();
}

}  // namespace

std::string page_of(const Comparison& comparison, const distance::Compared& result,
                    const std::array<std::string, 2>& files, bool solid) {
  page::Preview preview{"Distances"};
  preview.meaning = solid ? "distance from the other solid" : "distance from the other surface";
  for (const auto side : {Comparison::A, Comparison::B}) {
    const std::string name = side == Comparison::A ? "A" : "B";
    preview.facts.emplace_back(name, files[side] == "-"
                                         ? "standard input"
                                         : std::filesystem::path(files[side]).filename().string());
    page::Layer& layer = preview.layers.emplace_back();
    layer.name = name;
    layer.all_edges = true;
    layer.view = side == Comparison::A ? page::Layer::View::Shown : page::Layer::View::Transparent;
    page::Shape& shape = layer.shapes.emplace_back();
    shape.mesh = picture::refined(comparison.surface(side), comparison.diagonal() / 100, kMostCuts);
    shape.distances =
        comparison.distances(shape.mesh, side == Comparison::A ? Comparison::B : Comparison::A);
  }
  preview.facts.emplace_back("from A to B", interval(result.a_to_b, comparison.diagonal()));
  preview.facts.emplace_back("from B to A", interval(result.b_to_a, comparison.diagonal()));
  return page::preview_page(preview);
}

}  // namespace kaboum::tools
