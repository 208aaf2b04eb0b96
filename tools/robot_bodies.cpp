// Bodies of robots: formats of their meshes, notes on them.

#include "robot_bodies.h"

#include "files.h"

namespace kaboum::tools {

void require_formats(const robot::LinkMeshes& meshes, const std::string& format) {
  for (const robot::LinkMesh& mesh : meshes.meshes)
    static_cast<void>(format_for(mesh.file.string(), format, "--input-format"));
}

certify::RobotHooks hooks_of(Notes& notes, std::function<void(const std::string&)> progress) {
  certify::RobotHooks hooks;
  hooks.progress = std::move(progress);
  hooks.note = [&notes](const std::string& file, const std::string& text) {
    notes.add(file, text);
  };
  return hooks;
}

std::vector<std::string> strings(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> out;
  out.reserve(files.size());
  for (const std::filesystem::path& file : files) out.push_back(file.string());
  return out;
}

}  // namespace kaboum::tools
