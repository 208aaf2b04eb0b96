#pragma once

#include <kaboum/geom/transform.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene_set_maker.h"

/// Scenes from URDFs and meshes: their sets in containers, and the file that names them.
namespace kaboum::tools {

/// "NAME=FILE".
struct NamedFile {
  std::string name, file;
};
/// @throws Error{InvalidArgument} naming the option.
NamedFile parse_named_file(const std::string& text, const char* option);

/// "NAME=POSE" for each, see robot::parse_pose.
/// @throws Error{InvalidArgument} naming the option.
std::map<std::string, geom::Transform> parse_places(const std::vector<std::string>& texts,
                                                    const char* option);

/// "NAME=FACTOR" for each.
/// @throws Error{InvalidArgument} naming the option.
std::map<std::string, double> parse_scales(const std::vector<std::string>& texts,
                                           const char* option);

struct SceneMaker {
  std::filesystem::path scene;                    ///< to be written
  std::vector<NamedFile> robots;                  ///< URDF
  std::vector<NamedFile> objects, regions;        ///< meshes
  std::map<std::string, geom::Transform> places;  ///< of what is named; the origin for the others
  std::map<std::string, double> scales;           ///< of objects' and regions' meshes
  bool inner = false;                             ///< inner sets of objects as well
  SceneSetOptions options;                        ///< of everything
};

struct MadeScene {
  std::vector<std::filesystem::path> containers;  ///< written
  std::vector<std::string> inputs, notes;
  std::vector<std::string> sizes;  ///< how large each thing is, to see that its unit is right
  /// SceneSetMaker::bad_links: empty where all robots' links are held as asked for.
  std::vector<std::string> bad_links;
};

/// Computes what the cache lacks, writes the containers into the folder with the scene's stem
/// beside it, then the scene.
/// @throws Error naming the file; Error{InvalidArgument} where a place is of nothing.
MadeScene make_scene(const SceneMaker& maker);

}  // namespace kaboum::tools
