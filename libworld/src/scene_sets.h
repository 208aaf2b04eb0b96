#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/world/scene.h>

#include <optional>

#include "scene_values.h"

namespace kaboum::world::detail {

/// Files that a scene names, checked against the hash, direction and unit that it needs.
class SceneSets : public SceneValues {
 public:
  SceneSets(const SceneValues& values, const FileReader& read, std::string unit)
      : SceneValues(values), read_(read), unit_(std::move(unit)) {}

  struct File {
    std::string name;
    std::vector<char> bytes;
    std::string sha256;
  };
  /// The file {"file": …, "sha256": …}.
  File file(const Located& value) const;

  struct Loaded {
    geom::ConvexSet set;
    File file;
  };
  /// A container whose direction is the one needed, in the unit of the scene.
  Loaded container(const Located& value, const char* direction);
  BoundingSet set(const Loaded& loaded, const Located& value) const;
  BoundingSet set(const Located& object, const char* member, const char* direction);
  /// Of the member "inner", if there is one.
  std::optional<BoundingSet> optional_inner(const Located& object);

  std::vector<std::string> notes;  ///< for who uses the scene

 private:
  /// Says that a set does not cover all that its mesh has.
  void note_sheets(const Loaded& loaded);

  const FileReader& read_;
  std::string unit_;
};

}  // namespace kaboum::world::detail
