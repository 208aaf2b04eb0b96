// Names of what stands for a robot's meshes in its folder.

#include <kaboum/io/convex_io.h>

#include <algorithm>

#include "robot_folder.h"

namespace kaboum::tools {

namespace fs = std::filesystem;

/// No new file is to get this stem: those of bodies end with a number.
void RobotFolder::reserve_stem(const std::string& stem) {
  if (!extension_.empty()) names_.reserve(stem);
  const std::size_t dash = stem.rfind('-');
  if (dash != std::string::npos && stem.size() - dash > 4 &&
      stem.find_first_not_of("0123456789", dash + 1) == std::string::npos)
    names_.reserve(stem.substr(0, dash));
}

void RobotFolder::name_meshes(const robot::LinkMeshes& meshes, const robot::ShapeChoice& choice,
                              const std::vector<std::string>& taken) {
  for (const std::string& stem : taken) reserve_stem(stem);
  for (const robot::Link& link : robot_.links) reserve_stem(plain_file_name(link.name));
  for (const robot::LinkShape& shape : meshes.shapes) {
    std::optional<std::size_t>& index = of_shape_.emplace_back();
    if (!shape.mesh) continue;
    const geom::Vec3& scale = choice.shapes_of(robot_.links[shape.link])[shape.index].size;
    const auto same = std::find_if(stored_.begin(), stored_.end(), [&](const StoredMesh& s) {
      return s.mesh == *shape.mesh && s.scale == scale;
    });
    index = static_cast<std::size_t>(same - stored_.begin());
    if (same != stored_.end()) continue;
    const fs::path& file = meshes.meshes[*shape.mesh].file;
    const std::string wish = file.stem().string() + (extension_.empty() ? "" : "-outer");
    stored_.push_back({*shape.mesh, scale, names_.unique(wish), extension_});
    require_replaceable(stored_.back());
  }
}

void RobotFolder::require_replaceable(const StoredMesh& stored) const {
  const fs::path place = folder_ / place_of(stored);
  stored.extension.empty() ? io::require_replaceable(place) : require_replaceable(place);
}

void RobotFolder::leave_out(std::size_t mesh) {
  for (StoredMesh& s : stored_)
    if (s.mesh == mesh) s.left_out = true;
}

void RobotFolder::set_extension(std::size_t mesh, const std::string& extension) {
  for (StoredMesh& s : stored_) {
    if (s.mesh != mesh) continue;
    s.extension = extension;
    require_replaceable(s);
  }
}

}  // namespace kaboum::tools
