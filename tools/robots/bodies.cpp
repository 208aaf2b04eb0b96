// Robots as tools read them.

#include "bodies.h"

#include <kaboum/base/error.h>

namespace kaboum::tools {

void require_formats(const robot::LinkMeshes& meshes, const InputFormat& format) {
  if (!format.importer.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--importer: the meshes of robots are read without it, here and by what checks the "
                "result; let the robot name what mesh-prepare makes of a mesh (mesh-prepare MESH "
                "--importer assimp -o MESH.obj)");
  for (const robot::LinkMesh& mesh : meshes.meshes)
    if (mesh.missing.empty()) static_cast<void>(format_for(mesh.file.string(), format));
}

std::vector<std::string> strings(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> out;
  out.reserve(files.size());
  for (const std::filesystem::path& file : files) out.push_back(file.string());
  return out;
}

}  // namespace kaboum::tools
