#pragma once

#include <kaboum/certify/set_cache.h>
#include <kaboum/geom/transform.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/primitive.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Scenes from URDFs and meshes: their sets in containers, and the file that names them.
namespace kaboum::scene {

/// A robot's file, or a mesh, that a scene has by a name.
struct NamedFile {
  std::string name, file;
};

/// An object that is a primitive, which needs no set.
struct NamedPrimitive {
  std::string name;
  world::Primitive primitive;
};

/// Options of making a scene's sets.
struct SceneSetOptions {
  certify::SetRequest sets;             ///< of everything; direction apart
  bool visual = false;                  ///< of robots, shapes for drawing
  std::vector<std::string> links = {};  ///< of robots, only these; empty: all
  /// Links of robots that get an inner set as well; empty: all; by default none.
  std::optional<std::vector<std::string>> inner_links = {};
  std::vector<std::string> packages;         ///< folders that package:// URIs are looked up in
  const certify::SetCache* cache = nullptr;  ///< null: none
  std::function<void(const std::string&)> progress;
  /// Format of a mesh's file; by default as its extension says. May throw.
  std::function<io::Format(const std::string& file)> format_of = {};
};

/// Request for a scene.
struct SceneMaker {
  SceneMaker() { options.sets.epsilon = Length{1, true}; }

  std::filesystem::path scene;                    ///< to be written
  std::vector<NamedFile> robots;                  ///< URDF
  std::vector<NamedFile> objects, regions;        ///< meshes
  std::vector<NamedPrimitive> primitives;         ///< further objects
  std::map<std::string, geom::Transform> places;  ///< of what is named; the origin for the others
  std::map<std::string, double> scales;           ///< of objects' and regions' meshes
  bool inner = false;                             ///< inner sets of objects as well
  bool replace = false;     ///< a scene that exists, with all that was edited in it
  SceneSetOptions options;  ///< of everything
};

/// Files that were written, and notes on them for the user.
struct MadeScene {
  std::vector<std::filesystem::path> containers;  ///< written
  std::vector<std::string> inputs, notes;
  std::vector<std::string> sizes;  ///< how large each thing is, to see that its unit is right
  /// Links that are not held as asked for, each with its robot.
  std::vector<std::string> bad_links;
};

/// Refuses a place that a scene cannot have, or where one is already.
/// @throws Error{InvalidArgument}; Error{OutputFailed} where its folder is not there
void require_free_place(const std::filesystem::path& scene, bool replace);

/// Computes what the cache lacks, writes the containers into the folder with the scene's stem
/// beside it, then the scene.
/// @throws Error naming the file; Error{InvalidArgument} where a place is of nothing, where the
/// scene
///   or its folder is there already, or its unit is not that of a robot.
MadeScene make_scene(const SceneMaker& maker);

}  // namespace kaboum::scene
