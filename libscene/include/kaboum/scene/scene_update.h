#pragma once

#include <kaboum/scene/scene_maker.h>

namespace kaboum::scene {

/// A scene that is to be brought up to date.
struct SceneUpdate {
  std::filesystem::path scene;
  std::vector<std::string> packages;
  const certify::SetCache* cache = nullptr;  ///< null: none
  std::function<void(const std::string&)> progress;
  std::function<io::Format(const std::string& file)> format_of = {};  ///< as SceneSetOptions
};

/// Makes those sets of a scene anew that are out of date: containers, URDFs or meshes that they
/// were made from have changed or are gone. With the options that their records state; all links of
/// a robot together. Proofs of pairs of links that this ends are taken out, in a note. Everything
/// else in the scene stays; nothing is written when nothing is out of date.
/// @throws Error naming the file, and what cannot be made anew because it is not known how.
MadeScene update_scene(const SceneUpdate& update);

/// A scene's file and all that it names: robots, sets, and what they were made from.
/// @throws Error as world::scene_as_json, and where the file cannot be read
std::vector<std::string> files_of(const std::filesystem::path& scene);

}  // namespace kaboum::scene
