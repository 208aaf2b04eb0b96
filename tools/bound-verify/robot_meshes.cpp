// The meshes that two robots refer to, each read once.

#include "robot_meshes.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/mesh_files.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

namespace kaboum::tools {

namespace fs = std::filesystem;
using robot::Geometry;

const verify::MeshFile& RobotMeshes::file_of(const Geometry& g, const robot::RobotFile& robot,
                                             bool skip) {
  const auto [at, fresh] = named_.try_emplace({robot.path.string(), g.mesh});
  if (!fresh) return *at->second;
  if (skip) {
    const robot::FoundMesh found = files_of(robot).look_for(g.mesh);
    if (found.files.empty()) {
      // No file has this name, which holds its reader's place.
      verify::MeshFile file{g.mesh, {}, {}};
      file.error = Error(ErrorCode::InvalidInput, found.what);
      const std::string key = robot.path.string() + '\n' + g.mesh;
      return *(at->second = &files_.emplace(key, std::move(file)).first->second);
    }
  }
  const verify::MeshFile& file = read(files_of(robot).only(g.mesh).string());
  at->second = &file;
  return file;
}

robot::MeshFiles& RobotMeshes::files_of(const robot::RobotFile& robot) {
  return places_.try_emplace(robot.path.string(), robot.path, packages_).first->second;
}

const verify::MeshFile& RobotMeshes::read(const std::string& path) {
  const auto at = files_.find(path);
  if (at != files_.end()) return at->second;
  return files_.emplace(path, verify::read_mesh_file(path, exact_points_)).first->second;
}

std::string RobotMeshes::record_of_other_kind(const robot::RobotFile& original, bool visual) const {
  robot::MeshFiles meshes(original.path, packages_);
  const auto hashes_of = [&](bool drawn) {
    std::set<std::string> out;
    for (const robot::Link& link : original.robot.links)
      for (const Geometry& g : drawn ? link.visual : link.collision) try {
          if (g.shape == Geometry::Shape::Mesh)
            out.insert(io::sha256(io::read_file(meshes.first(g.mesh))));
        } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a note is not worth an error
        }
    return out;
  };
  const std::set<std::string> judged = hashes_of(visual), others = hashes_of(!visual);
  for (const auto& [path, file] : files_) {
    const fs::path record = fs::path(path).parent_path() / "convex-set.json";
    std::error_code error;
    if (!fs::is_regular_file(record, error)) continue;
    const std::vector<char> text = io::read_file(record);
    const auto json = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
    if (!json.is_object() || !json.contains("source_sha256")) continue;
    const auto& hash = json["source_sha256"];
    if (hash.is_string() && others.contains(hash.get<std::string>()) &&
        !judged.contains(hash.get<std::string>()))
      return record.string();
  }
  return {};
}

}  // namespace kaboum::tools
