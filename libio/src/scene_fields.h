#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene_copier.h"
#include "scene_graph.h"
#include "text.h"

namespace kaboum::io {

/// The values of fields in the nodes of one file. Internal to kaboum_io.
class SceneFields {
 public:
  SceneFields(const SceneFile& file, SceneCopier& copier) : file_(file), copier_(copier) {}

  /// Whether a value's place in the file is known; in X3D, only its element's line is.
  [[nodiscard]] bool has_places() const { return file_.xml == nullptr; }

  [[noreturn]] void fail_at(const char* where, const std::string& what) const;

  /// Fails at the value's place, if it is known.
  [[noreturn]] void fail_value(const SceneField& field, std::string_view value,
                               const std::string& what) const;

  [[noreturn]] void fail_field(const SceneNode& node, const SceneField& field) const;

  /// Takes the next value off the front of `text`; empty at its end.
  [[nodiscard]] std::string_view next_value(std::string_view& text) const {
    const auto is_space = [](char c) {
      return c == ',' || detail::char_class(c) != detail::kOther;
    };
    std::size_t i = 0;
    while (i < text.size() && (is_space(text[i]) || (text[i] == '#' && !file_.xml))) {
      if (text[i] == '#')
        while (i < text.size() && detail::char_class(text[i]) != detail::kEol) ++i;
      else
        ++i;
    }
    std::size_t end = i;
    while (end < text.size() && !is_space(text[end]) && (text[end] != '#' || file_.xml)) ++end;
    const std::string_view value = text.substr(i, end - i);
    text.remove_prefix(end);
    return value;
  }

  [[nodiscard]] double number(const SceneField& field, std::string_view value) const;

  [[nodiscard]] std::int64_t integer(const SceneField& field, std::string_view value) const;

  template <typename Vector>
  void read_vector(const SceneField& field, Vector& v) const {
    std::string_view text = field.text;
    copier_.spend(text);
    for (double& x : v) x = number(field, next_value(text));
    if (!next_value(text).empty())
      fail_at(field.where, in_quotes(field.name) + " has too many numbers");
  }

  [[nodiscard]] bool read_bool(const SceneField& field) const;

  [[nodiscard]] std::vector<std::int64_t> read_integers(const SceneField& field) const;

  /// The field's only value.
  [[nodiscard]] std::string_view single(const SceneField& field) const;

  /// The field's only node, or nullptr.
  [[nodiscard]] const SceneNode* only(const SceneField& field) const;

  /// Fields that any node may have.
  [[nodiscard]] bool read_common(const SceneField& field) const;

 private:
  const SceneFile& file_;
  SceneCopier& copier_;
};

}  // namespace kaboum::io
