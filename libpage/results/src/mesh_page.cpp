// Pages of bounding meshes.

#include <kaboum/page/mesh_page.h>

#include <kaboum/certify/mesh_options.h>
#include <kaboum/page/gaps.h>

#include <filesystem>
#include <iomanip>
#include <sstream>

namespace kaboum::page {
namespace {

std::string four_digits(double x) {
  std::ostringstream s;
  s << std::setprecision(4) << x;
  return s.str();
}

std::string words_of(const certify::Claim& claim) {
  std::string text = std::string(name_of(claim.answer)) + ", " + name_of(claim.basis);
  if (claim.distance) text = "at most " + four_digits(*claim.distance) + ": " + text;
  if (!claim.reason.empty()) text += ": " + claim.reason;
  return text;
}

}  // namespace

std::string summary_of(const certify::BoundedMesh& made, std::size_t place) {
  const certify::MeshCertificate& c = made.series.meshes[place].certificate();
  const double diagonal = made.series.plan.diagonal;
  certify::MeshOptions options;
  options.request.direction = c.direction;
  std::string line = std::to_string(c.statistics.vertices_in) + " → " + std::to_string(c.vertices) +
                     " vertices, " + value_of(certify::mesh_options(), "direction", options);
  if (c.direction != bmesh::Direction::Any)
    line += !c.closed ? ", NOTHING IS ENCLOSED: the mesh is open"
            : c.surface_answer() == verify::Answer::Verified ? ", certified"
                                                             : ", NOT ALL TRIANGLES ARE CERTIFIED";
  if (c.original_to_result) {
    const double wrap = made.wrap ? made.wrap->farthest_upper : 0;
    const double within = c.hausdorff_upper() + wrap;
    line += ", within " + four_digits(within) + " (" + four_digits(100 * within / diagonal) + "%)";
  }
  if (c.requested && c.stop == bmesh::Stop::ErrorBound)
    line += "; epsilon allows no fewer, " + std::to_string(*c.requested) + " were wished";
  return line;
}

std::string page_of_meshes(const MeshWords& words, const certify::BoundedMesh& bounded) {
  const std::vector<certify::CertifiedMesh>& meshes = bounded.series.meshes;
  const bool inner = meshes.front().certificate().direction == bmesh::Direction::Inner;
  const geom::Mesh& original = bounded.original.solid.mesh();
  const double extent = bounded.series.plan.diagonal;
  const std::string name = std::filesystem::path(words.file).filename().string();
  Preview preview{"Result of bmesh-decimate " + name};
  preview.meaning = "distance from the other surface";
  preview.facts.emplace_back("input", name + ", " + std::to_string(original.vertices.size()) +
                                          " vertices, " +
                                          std::to_string(original.triangles.size()) + " triangles" +
                                          (bounded.wrap ? " of a wrap round it" : ""));
  if (bounded.series.plan.epsilon)
    preview.facts.emplace_back("epsilon",
                               four_digits(*bounded.series.plan.epsilon) + " (" +
                                   four_digits(100 * *bounded.series.plan.epsilon / extent) +
                                   "% of the diagonal)");
  preview.layers.push_back({bounded.wrap ? "wrap" : "input",
                            inner ? Layer::View::Transparent : Layer::View::Shown, false});
  const geom::DistanceQuery to_original(original);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const certify::CertifiedMesh& made = meshes[i];
    const bool last = i + 1 == meshes.size();
    const std::string count = std::to_string(made.artefact().vertices.size()) + " vertices";
    Layer& result = preview.layers.emplace_back();
    result.name = meshes.size() == 1 ? "result" : count;
    result.view = !last   ? Layer::View::Hidden
                  : inner ? Layer::View::Shown
                          : Layer::View::Transparent;
    result.all_edges = true;
    result.shapes.push_back(measured(made.artefact(), extent, distance_to(to_original)));
    preview.facts.emplace_back(result.name, words.summaries[i]);
    for (const certify::Claim& claim : certificate_of(made).claims)
      preview.facts.emplace_back(name_of(claim.kind), words_of(claim));
    if (last) {
      const geom::DistanceQuery to_result(made.artefact());
      preview.layers.front().shapes.push_back(measured(original, extent, distance_to(to_result)));
    }
  }
  for (const std::string& note : words.notes) preview.facts.emplace_back("note", note);
  return preview_page(preview);
}

}  // namespace kaboum::page
