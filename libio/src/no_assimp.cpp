// Stands in for assimp.cpp when KABOUM_WITH_ASSIMP is off.

#include <kaboum/base/error.h>

#include "formats.h"

namespace kaboum::io {

bool has_assimp() { return false; }

ReadResult read_fbx(const Source& source) {
  throw Error(ErrorCode::NotBuilt,
              std::string(source.name) +
                  ": reading FBX needs assimp, which this build leaves out; build with "
                  "KABOUM_WITH_ASSIMP=ON or convert the file to obj, off, ply or stl");
}

}  // namespace kaboum::io
