// Folders of robots with enclosing meshes.

#include <kaboum/io/mesh_io.h>
#include <kaboum/robot_folder/enclosed_folder.h>

#include <map>
#include <span>

namespace kaboum::robot_folder {

void write_enclosed(RobotWriter& writer, const certify::LinkEnclosures& made,
                    const certify::CacheFolder* cache, const FileNote& note) {
  RobotFolder& folder = writer.folder();
  for (std::size_t i = 0; i < made.meshes.size(); ++i) {
    if (!made.meshes[i].flaw.empty())
      folder.leave_out(i);
    else if (made.meshes[i].made.enclosure.certificate().in_spare_format)
      folder.set_extension(i, ".obj");
  }
  const NewShapes shapes =
      new_shapes(writer.robot(), writer.options().shapes, made.shapes, [&](std::size_t s) {
        const certify::EnclosedLinkMesh& mesh = made.meshes[*made.shapes[s].mesh];
        std::optional<std::vector<std::string>> out(std::in_place);
        if (!mesh.mesh.missing.empty()) return out;
        if (!mesh.flaw.empty()) return decltype(out)();
        out->push_back(folder.place_of(s));
        return out;
      });
  if (cache != nullptr) {
    std::map<std::size_t, std::span<const char>> meshes;
    for (std::size_t s = 0; s < made.shapes.size(); ++s)
      if (const auto& mesh = made.shapes[s].mesh; mesh && made.meshes[*mesh].flaw.empty())
        meshes.emplace(s, made.meshes[*mesh].made.enclosure.bytes());
    writer.reuse(*cache, meshes);
  }
  writer.write(
      shapes,
      [&](const StoredMesh& stored, const std::filesystem::path& place) {
        io::write_file(place, made.meshes[stored.mesh].made.enclosure.bytes());
      },
      {}, note);
}

WrittenRobot write_robot(const std::string& folder, const robot::RobotFile& robot,
                         const certify::LinkEnclosures& made, FolderOptions options,
                         io::Format format, const certify::CacheFolder* cache,
                         const FileNote& note) {
  options.declare_convex = false;  // they are not
  robot::LinkMeshes meshes;
  meshes.shapes = made.shapes;
  for (const certify::EnclosedLinkMesh& mesh : made.meshes) meshes.meshes.push_back(mesh.mesh);
  RobotWriter writer(std::move(options), folder, robot, "meshes",
                     format == io::Format::Stl ? ".stl" : ".obj");
  writer.plan(meshes);
  write_enclosed(writer, made, cache, note);
  return {writer.documents(), writer.link_files(), writer.stale()};
}

}  // namespace kaboum::robot_folder
