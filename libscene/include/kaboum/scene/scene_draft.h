#pragma once

#include <kaboum/certify/convex_set.h>
#include <kaboum/certify/robot.h>
#include <kaboum/scene/scene_maker.h>
#include <kaboum/world/scene.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::scene {

/// A certified set of an object or a region, and the files that it was made from.
struct SceneSet {
  certify::CertifiedSet set;
  std::vector<std::filesystem::path> sources;  ///< its mesh's first; empty: it was made of no file
};

/// A scene that is put together in process, of certified robots, objects and regions.
///
/// What scene files say besides sets (docs/scene.md) is given as JSON objects, `members`: of a
/// robot "base", "home", "limits", "tools", ...; of an object "pose", "features", "grasps".
/// Several threads may call its functions at once: one waits for the other.
class SceneDraft {
 public:
  explicit SceneDraft(const std::string& unit = "m");
  /// A scene that was written, to be added to: what it has stays as it is, and it is written where
  /// it was.
  /// @throws as world::read_scene
  static SceneDraft read(const std::filesystem::path& file);

  SceneDraft(SceneDraft&&) noexcept;
  SceneDraft& operator=(SceneDraft&&) noexcept;
  ~SceneDraft();

  [[nodiscard]] std::string unit() const;
  /// The file that it was read from or written to last; empty: none.
  [[nodiscard]] std::filesystem::path file() const;

  /// @throws Error{InvalidArgument} where the name is taken, `members` is no object or names what
  ///   this function states itself; Error{InvalidInput} where it is no JSON
  void add_robot(const std::string& name, std::shared_ptr<const robot::RobotFile> file,
                 certify::CertifiedRobot made, const std::string& members);
  /// @param inner  lies in the object; none: its contacts are never certain
  /// @throws as add_robot; Error{InvalidArgument} where both sets are of one mesh, but not of one
  ///   scale
  void add_object(const std::string& name, SceneSet outer, std::optional<SceneSet> inner,
                  const std::string& members);
  void add_region(const std::string& name, SceneSet inner, const std::string& members);
  /// An object or a region that is a primitive: `shape` is the JSON of docs/scene.md, which reading
  /// the scene looks at.
  void add_primitive_object(const std::string& name, const std::string& shape,
                            const std::string& members);
  void add_primitive_region(const std::string& name, const std::string& shape,
                            const std::string& members);
  /// An entry of a list of the scene: "allowed_contacts" or "attachments".
  void add_entry(const std::string& list, const std::string& entry);

  /// The text of the scene as it would be written as JSON.
  [[nodiscard]] std::string json() const;

  /// Contents of the scene, as world::read_scene reads it; nothing needs to be written for that.
  /// @throws as world::parse_scene
  [[nodiscard]] world::SceneFile world() const;

  /// Writes containers into the folder with the scene's stem beside it, then the scene.
  /// @param replace  a scene that exists, or one that has changed since it was read or written
  /// @return inputs, sizes and notes of what was added
  /// @throws Error{InvalidArgument} where a scene is there, or it was read elsewhere;
  ///   Error{InvalidInput} where reading would refuse it; Error{OutputFailed}
  MadeScene write(const std::filesystem::path& scene, bool replace);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kaboum::scene
