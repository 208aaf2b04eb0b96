#pragma once

#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>

#include <string>
#include <vector>

#include "common/report.h"

namespace kaboum::tools {

/// One thing that preparation changed.
struct Repair {
  std::string kind;       ///< "hole filled", "triangles turned", ...
  std::size_t count = 0;  ///< of triangles, vertices or edges, as the kind says
  geom::Box3 box;         ///< where; empty if nowhere in particular
};

/// What reading and preparing changed, holes each by itself.
std::vector<Repair> repairs_of(const io::ReadResult& input, const geom::Prepared& prepared);

/// With `place`, the box's middle, and `size`, its diagonal, where there is a place.
Json to_json(const std::vector<Repair>& repairs);

/// "2 holes filled, 12 triangles turned"; "nothing" if nothing.
std::string in_words(const std::vector<Repair>& repairs);

}  // namespace kaboum::tools
