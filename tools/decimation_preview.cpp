// What bmesh-decimate shows on pages.

#include <filesystem>

#include "decimation_case.h"
#include "player/gaps.h"

namespace kaboum::tools {
namespace {

using page::Layer;

std::string words_of(const certify::MeshClaim& claim) {
  std::string text = std::string(name_of(claim.answer)) + ", " + name_of(claim.basis);
  if (claim.distance) text = "at most " + formatted(*claim.distance) + ": " + text;
  if (!claim.reason.empty()) text += ": " + claim.reason;
  return text;
}

}  // namespace

std::string page_of(const DecimationCase& run) {
  const bool inner = run.request().direction == bmesh::Direction::Inner;
  const geom::Mesh& original = run.original().solid.mesh();
  const double extent = run.series().plan.diagonal;
  const std::string name = std::filesystem::path(run.asked.input).filename().string();
  page::Preview preview{"Result of bmesh-decimate " + name};
  preview.meaning = "distance from the other surface";
  preview.facts.emplace_back("input", name + ", " + std::to_string(original.vertices.size()) +
                                          " vertices, " +
                                          std::to_string(original.triangles.size()) + " triangles" +
                                          (run.wrap() ? " of a wrap round it" : ""));
  if (run.series().plan.epsilon)
    preview.facts.emplace_back("epsilon", formatted(*run.series().plan.epsilon) + " (" +
                                              formatted(100 * *run.series().plan.epsilon / extent) +
                                              "% of the diagonal)");
  preview.layers.push_back({run.wrap() ? "wrap" : "input",
                            inner ? Layer::View::Transparent : Layer::View::Shown, false});
  const geom::DistanceQuery to_original(original);
  for (std::size_t i = 0; i < run.series().meshes.size(); ++i) {
    const certify::CertifiedMesh& made = run.series().meshes[i];
    const bool last = i + 1 == run.series().meshes.size();
    const std::string count = std::to_string(made.artefact().vertices.size()) + " vertices";
    Layer& result = preview.layers.emplace_back();
    result.name = run.series().meshes.size() == 1 ? "result" : count;
    result.view = !last   ? Layer::View::Hidden
                  : inner ? Layer::View::Shown
                          : Layer::View::Transparent;
    result.all_edges = true;
    result.shapes.push_back(
        page::measured(made.artefact(), extent, page::distance_to(to_original)));
    preview.facts.emplace_back(result.name, summary_of(run, i));
    for (const certify::MeshClaim& claim : claims(made))
      preview.facts.emplace_back(name_of(claim.kind), words_of(claim));
    if (last) {
      const geom::DistanceQuery to_result(made.artefact());
      preview.layers.front().shapes.push_back(
          page::measured(original, extent, page::distance_to(to_result)));
    }
  }
  for (const std::string& note : run.notes) preview.facts.emplace_back("note", note);
  return page::preview_page(preview);
}

}  // namespace kaboum::tools
