#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/world/scene.h>

#include <map>
#include <optional>
#include <utility>

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
  /// The file {"file": …, "sha256": …}; `more` are other members that it may have.
  File file(const Located& value, const std::vector<std::string>& more = {}) const;

  struct Loaded {
    geom::ConvexSet set;
    File file;
    std::optional<std::vector<std::string>> made_from;  ///< hashes of these files, if they are said
  };
  /// A container whose direction is the one needed, in the unit of the scene.
  Loaded container(const Located& value, const char* direction);
  BoundingSet set(const Loaded& loaded, const Located& value) const;
  /// Refuses a set whose own record names another source than `robot` (hash of its file, or empty)
  /// and the files that it was made from.
  void require_source(const Loaded& loaded, const Located& value, const std::string& robot) const;
  BoundingSet set(const Located& object, const char* member, const char* direction);
  /// The members "outer" and, if there is one, "inner" of an object.
  std::pair<BoundingSet, std::optional<BoundingSet>> sets_of(const Located& object);
  /// Refuses an inner set that reaches out of the outer set's box: they are not of one solid.
  void require_within(const Loaded& inner, const Loaded& outer, const Located& at) const;
  /// Says of which sets nothing is known that would tell when they are out of date.
  void note_unknown_sources();

  std::vector<std::string> notes;  ///< for who uses the scene

 private:
  /// Hashes of the files of "made_from", which are what they were.
  std::vector<std::string> sources(const Located& list, const std::string& set);
  /// Says that a set does not cover all that its mesh has.
  void note_sheets(const Loaded& loaded);

  const FileReader& read_;
  std::string unit_;
  std::map<std::string, std::string> hashes_;  ///< of files that sets were made from
  std::vector<std::string> of_unknown_source_;
};

}  // namespace kaboum::world::detail
