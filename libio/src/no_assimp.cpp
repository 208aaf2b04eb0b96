// Stands in for assimp.cpp when KABOUM_WITH_ASSIMP is off.

#include <kaboum/base/error.h>

#include "formats.h"

namespace kaboum::io {

namespace {

[[noreturn]] void refuse(const Source& source, const std::string& format) {
  throw Error(ErrorCode::NotBuilt,
              std::string(source.name) + ": reading " + format +
                  " needs assimp, which this build leaves out; build with KABOUM_WITH_ASSIMP=ON or "
                  "convert the file to obj, off, ply or stl");
}

}  // namespace

bool has_assimp() { return false; }

ReadResult read_fbx(const Source& source) { refuse(source, "FBX"); }

ReadResult read_by_assimp(const Source& source) {
  refuse(source, "." + std::string(imported_extension(source.name)));
}

}  // namespace kaboum::io
