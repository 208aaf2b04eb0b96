// Scenes from the file system.

#include <kaboum/io/mesh_io.h>
#include <kaboum/world/scene.h>

#include <filesystem>

namespace kaboum::world {

SceneFile read_scene(const std::string& path) {
  SceneFile out;
  out.inputs.push_back(path);
  const std::vector<char> bytes = io::read_file(path);
  out.sha256 = io::sha256(bytes);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  SceneNotes notes;
  out.world = parse_scene(
      {bytes.data(), bytes.size()}, path,
      [&](const std::string& file) {
        out.inputs.push_back((folder / file).string());
        return io::read_file(folder / file);
      },
      &notes);
  out.notes = std::move(notes.notes);
  return out;
}

}  // namespace kaboum::world
