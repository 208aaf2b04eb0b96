// Stands in for assimp.cpp when KABOUM_WITH_ASSIMP is off.

#include <kaboum/geom/error.h>

#include "formats.h"

namespace kaboum::io {

bool has_assimp() { return false; }

ReadResult read_with_assimp(const Source& source, Format /*format*/) {
  throw Error(ErrorCode::NotBuilt,
              std::string(source.name) +
                  ": reading this format needs assimp, which this build leaves out; build with "
                  "KABOUM_WITH_ASSIMP=ON or convert the file to obj, off, ply or stl");
}

}  // namespace kaboum::io
