// Robots as tools read them.

#include "bodies.h"

#include "common/files.h"

namespace kaboum::tools {

void require_formats(const robot::LinkMeshes& meshes, const std::string& format) {
  for (const robot::LinkMesh& mesh : meshes.meshes)
    if (mesh.missing.empty())
      static_cast<void>(format_for(mesh.file.string(), format, "--input-format"));
}

std::vector<std::string> strings(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> out;
  out.reserve(files.size());
  for (const std::filesystem::path& file : files) out.push_back(file.string());
  return out;
}

}  // namespace kaboum::tools
