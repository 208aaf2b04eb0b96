// The folder of a robot's bodies: whose it is, names in it, what is written.

#include "robot_folder.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <set>

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

void create(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::OutputFailed,
                folder.string() + ": cannot be created: " + error.message());
}

}  // namespace

RobotFolder::RobotFolder(fs::path folder, const robot::RobotFile& robot)
    : folder_(std::move(folder)), urdf_(folder_ / robot.path.filename()), robot_(robot.robot) {
  std::error_code error;
  if (fs::equivalent(urdf_, robot.path, error))
    throw Error(ErrorCode::InvalidArgument,
                urdf_.string() + ": would overwrite the input; name another folder");
  require_own();
}

/// Bodies are named after their meshes: those of another robot in the folder would be replaced.
void RobotFolder::require_own() const {
  std::error_code error;
  if (fs::exists(urdf_, error) && !fs::exists(folder_ / "bodies", error))
    throw Error(ErrorCode::OutputFailed,
                urdf_.string() + ": exists, and not with bodies/ beside it as a result of this " +
                    "program would; remove it or name another folder");
  for (const auto& entry : fs::directory_iterator(folder_, error))
    if (entry.path().extension() == ".urdf" && entry.path().filename() != urdf_.filename())
      throw Error(ErrorCode::OutputFailed,
                  entry.path().string() +
                      ": another robot, whose bodies would be replaced; name another folder");
}

/// No body is to get this name: those of bodies end with a number.
void RobotFolder::reserve_stem(const std::string& stem) {
  const std::size_t dash = stem.rfind('-');
  if (dash != std::string::npos && stem.size() - dash > 4 &&
      stem.find_first_not_of("0123456789", dash + 1) == std::string::npos)
    names_.reserve(stem.substr(0, dash));
}

void RobotFolder::name_bodies(const robot::LinkMeshes& meshes, const robot::ShapeChoice& choice,
                              const std::vector<std::string>& taken) {
  for (const std::string& stem : taken) reserve_stem(stem);
  for (const robot::Link& link : robot_.links) reserve_stem(plain_file_name(link.name));
  for (const robot::LinkShape& shape : meshes.shapes) {
    std::optional<std::size_t>& index = of_shape_.emplace_back();
    if (!shape.mesh) continue;
    const geom::Vec3& scale = choice.shapes_of(robot_.links[shape.link])[shape.index].size;
    const auto same = std::find_if(stored_.begin(), stored_.end(), [&](const Stored& s) {
      return s.mesh == *shape.mesh && s.scale == scale;
    });
    index = static_cast<std::size_t>(same - stored_.begin());
    if (same != stored_.end()) continue;
    const fs::path& file = meshes.meshes[*shape.mesh].file;
    stored_.push_back({*shape.mesh, scale, names_.unique(file.stem().string())});
    io::require_replaceable(folder_ / "bodies" / stored_.back().name);
  }
}

std::vector<std::string> RobotFolder::write(const certify::CertifiedRobot& made,
                                            const std::string& urdf) {
  create(folder_ / "bodies");
  create(folder_ / "links");
  for (const Stored& s : stored_)
    io::write_convex_set(folder_ / "bodies" / s.name,
                         made.bodies.certificate().meshes[s.mesh].made.found.set.artefact(),
                         io::SetFormat::Directory, s.name);
  FileNames names;
  for (const certify::CertifiedLink& link : made.links) {
    links_.push_back("links/" + names.unique(robot_.links[link.certificate().link].name) + ".glb");
    io::write_file(folder_ / links_.back(), link.bytes());
  }
  io::write_file(urdf_, urdf);
  return links_;
}

std::vector<std::string> RobotFolder::stale() const {
  std::set<fs::path> written;
  for (const Stored& s : stored_) written.insert(fs::path("bodies") / s.name);
  for (const std::string& file : links_) written.insert(file);
  std::vector<std::string> out;
  for (const char* part : {"bodies", "links"}) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_ / part, error)) {
      const fs::path name = fs::path(part) / entry.path().filename();
      if (!written.contains(name)) out.push_back(name.generic_string());
    }
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace kaboum::tools
