#pragma once

#include <string>
#include <utility>
#include <vector>

/// STEP and IGES files of OpenCASCADE's own making, each with something that readers get wrong.
namespace kaboum::test {

struct CadModel {
  std::string name;  ///< with its extension
  std::string text;
  /// Faces that OpenCASCADE does not read: their entity, and three coordinates of each point.
  std::vector<std::pair<int, std::vector<double>>> unread = {};
};

/// Twenty: assemblies with instances, mirrored ones, inches, a tessellated solid, threads, thin
/// ribs, splines with spikes on edges, spheres, cones, tori, holes, shells, loose faces, several
/// solids. Always the same bytes, but for the date in their headers.
std::vector<CadModel> cad_models();

}  // namespace kaboum::test
