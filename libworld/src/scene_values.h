#pragma once

#include <kaboum/geom/transform.h>
#include <kaboum/world/primitive.h>

#include <string>
#include <string_view>
#include <vector>

#include "located_json.h"

namespace kaboum::world::detail {

using geom::Transform;
using geom::Vec3;

/// Values of a scene file. What is not as expected is an Error{InvalidInput} that names file, line
/// and column.
class SceneValues {
 public:
  /// Both must outlive it.
  SceneValues(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  [[noreturn]] void fail(const Located& at, const std::string& what) const;

  /// Refuses what is no object, and members of other names.
  void known(const Located& object, const std::vector<std::string>& names) const;

  /// The member of that name; nullptr: there is none.
  static const Located* find(const Located& object, const char* name);
  const Located& need(const Located& object, const char* name) const;
  /// Items of the array of that name; none where it is missing.
  const std::vector<Located>& list(const Located& object, const char* name) const;
  const std::vector<Located>& array(const Located& value) const;
  const std::string& string(const Located& value) const;
  double number(const Located& value) const;
  std::vector<double> numbers(const Located& value, std::size_t count) const;
  Vec3 vector(const Located& value) const;
  Vec3 unit_vector(const Located& value) const;

  /// The shape {"KIND": {sizes}}.
  Primitive primitive(const Located& value) const;

  /// The pose in the members of an object.
  Transform pose(const Located& object) const;
  Transform pose_member(const Located& object, const char* name) const;

  [[nodiscard]] const std::string& file_name() const { return name_; }

 private:
  std::string_view text_;
  const std::string& name_;
};

}  // namespace kaboum::world::detail
