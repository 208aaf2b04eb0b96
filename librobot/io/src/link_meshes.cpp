// The mesh files that a robot's shapes refer to, each scale of them once.

#include <kaboum/base/error.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/mesh_files.h>

#include <algorithm>
#include <map>

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;

/// What meshes' names stand for, each looked for once.
class MeshPlaces {
 public:
  MeshPlaces(const RobotFile& robot, const std::vector<std::string>& packages)
      : files_(robot.path, packages) {}

  const FoundMesh& of(const std::string& reference) {
    const auto [at, fresh] = found_.try_emplace(reference);
    if (fresh) at->second = files_.look_for(reference);
    return at->second;
  }

 private:
  MeshFiles files_;
  std::map<std::string, FoundMesh> found_;
};

std::string place_in(const RobotFile& robot, int line) {
  std::string out = robot.path.string();
  if (line > 0) out.append(":").append(std::to_string(line));
  return out;
}

std::vector<MissingMesh> missing_of(const RobotFile& robot, const ShapeChoice& choice,
                                    MeshPlaces& places) {
  std::vector<MissingMesh> out;
  for (const Link& link : robot.robot.links) {
    if (!choice.has(link)) continue;
    for (const Geometry& g : choice.shapes_of(link)) {
      if (g.shape != Geometry::Shape::Mesh || !places.of(g.mesh).files.empty()) continue;
      auto at = std::ranges::find(out, g.mesh, &MissingMesh::reference);
      if (at == out.end()) at = out.insert(at, {g.mesh, g.line, {}, places.of(g.mesh).why});
      if (std::ranges::find(at->links, link.name) == at->links.end())
        at->links.push_back(link.name);
    }
  }
  return out;
}

}  // namespace

bool ShapeChoice::has(const Link& link) const {
  return links.empty() || std::find(links.begin(), links.end(), link.name) != links.end();
}

const std::vector<Geometry>& ShapeChoice::shapes_of(const Link& link) const {
  for (const UnreadShape& unread : link.unread)
    if (unread.visual == visual && !unread.refusal.empty())
      throw Error(ErrorCode::InvalidInput, unread.refusal);
  return visual ? link.visual : link.collision;
}

std::vector<MissingMesh> missing_meshes(const RobotFile& robot, const ShapeChoice& choice) {
  require_links(robot, choice.links);
  MeshPlaces places(robot, choice.packages);
  return missing_of(robot, choice, places);
}

std::string in_words(const RobotFile& robot, const std::vector<MissingMesh>& missing) {
  const auto said = [&](const MissingMesh& mesh) {
    return "no mesh file for '" + mesh.reference + "' of " +
           (mesh.links.size() == 1 ? "link " : "links ") + names_of(mesh.links);
  };
  if (missing.size() == 1)
    return place_in(robot, missing[0].line) + ": " + said(missing[0]) + ": " + missing[0].why;
  std::string out =
      robot.path.string() + ": " + std::to_string(missing.size()) + " meshes have no file:";
  std::vector<std::string> reasons;
  for (const MissingMesh& mesh : missing) {
    if (std::ranges::find(reasons, mesh.why) == reasons.end()) reasons.push_back(mesh.why);
    out += "\n  " + place_in(robot, mesh.line) + ": " + said(mesh);
  }
  // Of several the last ones are mostly the same with another name.
  constexpr std::size_t kMost = 3;
  for (std::size_t i = 0; i < std::min(kMost, reasons.size()); ++i) out += "\n" + reasons[i];
  if (reasons.size() > kMost)
    out += "\nand " + std::to_string(reasons.size() - kMost) + " more reasons of this kind";
  return out;
}

void require_meshes(const RobotFile& robot, const ShapeChoice& choice) {
  if (const auto missing = missing_meshes(robot, choice); !missing.empty())
    throw Error(ErrorCode::InvalidInput, in_words(robot, missing));
}

LinkMeshes link_meshes(const RobotFile& robot, const ShapeChoice& choice) {
  require_links(robot, choice.links);
  MeshPlaces places(robot, choice.packages);
  if (!choice.skip_missing)
    if (const auto missing = missing_of(robot, choice, places); !missing.empty())
      throw Error(ErrorCode::InvalidInput, in_words(robot, missing));
  LinkMeshes out;
  const auto index_of = [&](const Geometry& g) {
    const FoundMesh& found = places.of(g.mesh);
    LinkMesh mesh;
    mesh.scale = g.size.cwiseAbs();  // mirrored, bodies are the same
    if (found.files.empty()) {
      mesh.file = mesh.place = g.mesh;
      mesh.missing = place_in(robot, g.line) + ": no mesh file for '" + g.mesh + "': " + found.what;
    } else {
      mesh.file = found.files.front();
      if (std::find(out.files.begin(), out.files.end(), mesh.file) == out.files.end())
        out.files.push_back(mesh.file);
      // By its place, not by its bytes, which may refer to other files.
      std::error_code error;
      mesh.place = fs::canonical(mesh.file, error);
      if (error) mesh.place = mesh.file;
    }
    const auto same = std::ranges::find_if(out.meshes, [&](const LinkMesh& other) {
      return other.place == mesh.place && other.scale == mesh.scale &&
             other.missing.empty() == mesh.missing.empty();
    });
    const auto index = static_cast<std::size_t>(same - out.meshes.begin());
    if (same == out.meshes.end()) out.meshes.push_back(std::move(mesh));
    return index;
  };
  for (std::uint32_t l = 0; l < robot.robot.links.size(); ++l) {
    const Link& link = robot.robot.links[l];
    if (!choice.has(link)) continue;
    const std::vector<Geometry>& shapes = choice.shapes_of(link);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      LinkShape shape{l, i, {}};
      if (shapes[i].shape == Geometry::Shape::Mesh) shape.mesh = index_of(shapes[i]);
      out.shapes.push_back(shape);
    }
  }
  return out;
}

}  // namespace kaboum::robot
