// What programs need of robots that they load.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/robot_folder/loaders.h>

#include <filesystem>

namespace kaboum::robot_folder {

const std::vector<Loader>& loaders() {
  static const std::vector<Loader> all{
      {.name = "moveit", .package = true},
      // Its float32 loses bodies thinner than 1/10,000 of their size: 0.1 mm does for 1 m.
      {.name = "mujoco", .mjcf = true, .thickness = 0.0001},
      {.name = "gazebo", .sdf = true},
      {.name = "bullet"},
      {.name = "drake", .bodies = "obj", .declare_convex = true}};
  return all;
}

const Loader& loader_of(const std::string& name) {
  std::vector<std::string> names;
  for (const Loader& loader : loaders()) {
    if (loader.name == name) return loader;
    names.emplace_back(loader.name);
  }
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  throw Error(ErrorCode::InvalidArgument, "'" + name +
                                              "' is none of the programs that are known (" + known +
                                              ")" + did_you_mean(name, names));
}

std::string package_prefix(const std::string& folder) {
  const std::filesystem::path path =
      std::filesystem::absolute(std::filesystem::path(folder)).lexically_normal();
  const std::filesystem::path named = path.filename().empty() ? path.parent_path() : path;
  return "package://" + named.filename().string();
}

void apply(const Loader& loader, const std::string& folder, FolderOptions& options) {
  if (!options.mjcf && !options.sdf) {
    options.mjcf = loader.mjcf;
    options.sdf = loader.sdf;
  }
  if (options.mesh_prefix.empty() && loader.package) options.mesh_prefix = package_prefix(folder);
  options.bodies = loader.bodies;
  options.declare_convex = loader.declare_convex;
}

}  // namespace kaboum::robot_folder
