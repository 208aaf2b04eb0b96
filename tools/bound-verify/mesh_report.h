#pragma once

#include <kaboum/geom/inside_out.h>

#include <optional>
#include <string>
#include <vector>

#include "mesh_input.h"

/// What is said of two files that were judged, in words and as a report.
namespace kaboum::tools {

/// What was asked, of which files, and what was found.
struct MeshCase {
  const VerifyMeshOptions& asked;
  MeshInput original;
  ApproximationInput approximation;
  std::optional<geom::InsideOut> inside_out;  ///< of the original, where it is judged as it is
  double diagonal = 0;                        ///< of the original's box [length]
  std::optional<double> bound;                ///< of distances [length]
  verify::MeshVerdict verdict;

  [[nodiscard]] bool inner() const { return asked.relation == verify::Relation::Inner; }
};

/// Of the box; its square may exceed all doubles, or vanish.
double diagonal_of(const geom::Mesh& mesh);

/// The triangle where what sticks out is farthest, as the file numbers it; none where a hole was
/// filled. Meshes that are not prepared are as the file.
std::optional<std::uint32_t> triangle_in_file(const MeshCase& run, std::uint32_t triangle);

/// Convexity and the claims of enclosure, a line each.
std::vector<std::string> lines_of_enclosure(const MeshCase& run);
/// Why no points of exact faces were looked at; empty where they were, or there are no such faces.
std::string why_no_points(const MeshCase& run);
/// Distances and depth, a line each.
std::vector<std::string> lines_of_distances(const MeshCase& run);
/// "verified", and what has to be said with it.
std::string last_line(const MeshCase& run);
/// What an enclosure says little about, and what users most often got wrong when one is refuted.
std::vector<std::string> notes_on(const MeshCase& run);
/// Why the verdict is undefined.
/// @pre it is
std::string why_undefined(const MeshCase& run);

/// The report; without the time it took, the same for any number of threads.
Json report_of(const MeshCase& run);

}  // namespace kaboum::tools
