#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::world::detail {

/// A value of JSON or YAML that knows where it is in its text.
struct Located {
  enum class Kind { Null, Boolean, Number, String, Array, Object };
  Kind kind = Kind::Null;
  std::size_t at = 0;  ///< byte at which it begins
  bool boolean = false;
  double number = 0;
  std::string text;
  std::vector<Located> items;         ///< of an array
  std::vector<std::string> names;     ///< of an object's members, in their order
  std::vector<Located> values;        ///< of these
  std::vector<std::size_t> names_at;  ///< where their names begin
};

const char* name_of(Located::Kind kind);

/// The first member whose name another one has before it.
std::optional<std::size_t> repeated_member(const Located& object);

/// @param name  of the file, for messages.
/// @throws Error{InvalidInput} naming line and column: not JSON, a member twice.
Located parse_located(std::string_view text, const std::string& name);

/// The same of YAML: the core schema of its version 1.2, without anchors, tags and what version 1.1
/// reads otherwise.
/// @throws Error{InvalidInput} also for these; Error{NotBuilt} without yaml-cpp.
Located parse_located_yaml(std::string_view text, const std::string& name);

/// By the ending of the file's name: .yaml and .yml, else JSON.
inline bool is_yaml(std::string_view name) {
  return name.ends_with(".yaml") || name.ends_with(".yml");
}

}  // namespace kaboum::world::detail
