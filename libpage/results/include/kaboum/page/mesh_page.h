#pragma once

#include <kaboum/certify/mesh.h>

#include <string>
#include <vector>

/// Pages of bounding meshes over what they bound. docs/pages.md.
namespace kaboum::page {

/// What became of one result of a series, in one line.
std::string summary_of(const certify::BoundedMesh& made, std::size_t place);

/// What is said of bounding meshes beside their picture.
struct MeshWords {
  std::string file;                    ///< name, or what the mesh is called
  std::vector<std::string> summaries;  ///< of each result
  std::vector<std::string> notes;
};

/// A page that shows the results of a series over the original.
/// @pre There is a result.
std::string page_of_meshes(const MeshWords& words, const certify::BoundedMesh& made);

}  // namespace kaboum::page
