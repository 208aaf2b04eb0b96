// The folder of a robot with certified convex bodies.

#include <kaboum/io/convex_folder.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot_folder/certified_folder.h>

#include <algorithm>
#include <map>
#include <span>

namespace kaboum::robot_folder {
namespace {

/// The files of the bodies, relative to the folder.
NewShapes shapes_of(const RobotWriter& writer, const certify::BodiesCertificate& bodies) {
  const RobotFolder& folder = writer.folder();
  return new_shapes(writer.robot(), bodies.choice, bodies.shapes, [&](std::size_t s) {
    const std::string& name = folder.name_of(s);
    std::optional<std::vector<std::string>> out(std::in_place);
    const certify::CertifiedLinkMesh& mesh = bodies.meshes[*bodies.shapes[s].mesh];
    if (!mesh.mesh.missing.empty()) return out;
    if (!mesh.held) return decltype(out)();
    const std::size_t count = mesh.made.found.set.artefact().bodies.size();
    for (std::size_t b = 0; b < count; ++b)
      out->push_back(folder.part() + "/" + name + "/" + io::default_name(b, name) + "." +
                     writer.options().bodies);
    return out;
  });
}

/// Number of the shapes of the same link before one.
std::size_t count_before(const std::vector<robot::LinkShape>& shapes, std::size_t s) {
  return static_cast<std::size_t>(
      std::count_if(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(s),
                    [&](const robot::LinkShape& other) { return other.link == shapes[s].link; }));
}

}  // namespace

void write_certified(RobotWriter& writer, const certify::CertifiedRobot& made,
                     const certify::CacheFolder* cache, const FileNote& note) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  const bool obj = writer.options().bodies == "obj";
  for (std::size_t i = 0; i < bodies.meshes.size(); ++i)
    if (!bodies.meshes[i].held) writer.folder().leave_out(i);
  const auto write_mesh = [&](const StoredMesh& s, const std::filesystem::path& place) {
    io::write_convex_folder(place, bodies.meshes[s.mesh].made.found.set.artefact(), s.name,
                            obj ? io::Format::Obj : io::Format::Stl);
  };
  std::vector<std::pair<std::string, std::span<const char>>> links;
  for (const certify::CertifiedLink& link : made.links)
    links.emplace_back(writer.robot().robot.links[link.certificate().link].name, link.bytes());
  if (cache != nullptr) {
    std::map<std::size_t, std::span<const char>> meshes;
    for (std::size_t s = 0; s < bodies.shapes.size(); ++s)
      if (const auto& mesh = bodies.shapes[s].mesh; mesh && bodies.meshes[*mesh].held)
        meshes.emplace(s, bodies.meshes[*mesh].made.found.set.bytes());
    writer.reuse(*cache, meshes);
  }
  const NewShapes shapes = shapes_of(writer, bodies);
  std::map<std::string, const geom::Mesh*> by_file;
  for (std::size_t s = 0; s < bodies.shapes.size(); ++s) {
    const robot::LinkShape& shape = bodies.shapes[s];
    if (shapes[shape.link].empty()) continue;  // it stays as it is
    const auto& files = shapes[shape.link][count_before(bodies.shapes, s)].meshes;
    if (!files || files->empty()) continue;  // it is a mesh that stays, or that is left out
    const auto& set = bodies.meshes[*shape.mesh].made.found.set.artefact();
    for (std::size_t b = 0; b < files->size(); ++b) by_file[(*files)[b]] = &set.bodies[b].core;
  }
  writer.set_meshes([&](const std::string& file) {
    const auto found = by_file.find(file);
    return found == by_file.end() ? nullptr : found->second;
  });
  writer.write(shapes, write_mesh, std::move(links), note);
}

WrittenRobot write_robot(const std::string& folder, const robot::RobotFile& robot,
                         const certify::CertifiedRobot& made, FolderOptions options,
                         const std::vector<std::pair<std::string, std::string>>& documents,
                         const certify::CacheFolder* cache, const FileNote& note) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  options.shapes = bodies.choice;
  robot::LinkMeshes meshes;
  meshes.shapes = bodies.shapes;
  for (const certify::CertifiedLinkMesh& mesh : bodies.meshes) meshes.meshes.push_back(mesh.mesh);
  RobotWriter writer(std::move(options), folder, robot, "bodies", "");
  writer.plan(meshes);
  for (const auto& [extension, text] : documents) {
    writer.folder().require_own_document(extension);
    writer.add_document(extension, text);
  }
  write_certified(writer, made, cache, note);
  return {writer.documents(), writer.link_files(), writer.stale()};
}

}  // namespace kaboum::robot_folder
