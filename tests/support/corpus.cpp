#include "support/corpus.h"

#include <cstdlib>
#include <stdexcept>

namespace kaboum::test {

std::filesystem::path corpus() {
  const char* const folder = std::getenv("KABOUM_MESHES");
  if (folder == nullptr || *folder == '\0')
    throw std::runtime_error("KABOUM_MESHES must name the folder of the mesh collection");
  return folder;
}

}  // namespace kaboum::test
