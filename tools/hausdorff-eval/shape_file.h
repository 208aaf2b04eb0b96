#pragma once

#include <kaboum/distance/compare.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/files.h"
#include "common/unit_option.h"

namespace kaboum::tools {

/// A mesh or a set of bodies from a file.
struct ShapeFile {
  distance::Shape shape;
  bool is_set = false;
  std::size_t bodies = 0;         ///< of a set
  nlohmann::ordered_json margin;  ///< of a set, as margin_json
  double deviation = 0;           ///< of exact faces from the triangles; 0: there are none [length]
  std::string sha256;
  std::string unit;                ///< that it states, or that was said; empty: none
  std::vector<std::string> notes;  ///< things a user should know
};

struct ShapeOptions {
  /// auto: a set if it is a folder, a container, or a GLB or OBJ file with several bodies that are
  /// all convex.
  std::string as = "auto";  ///< auto, mesh or set
  InputFormat format;       ///< of standard input and unknown extensions
  UnitOption unit = {};     ///< of a mesh
};

/// @throws Error naming the file.
ShapeFile read_shape(const std::string& path, const ShapeOptions& options);

}  // namespace kaboum::tools
