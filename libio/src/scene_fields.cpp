// Values of VRML 97 and X3D: numbers, truth values and nodes of fields, or why there are none.
#include "scene_fields.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "names.h"

namespace kaboum::io {

void SceneFields::fail_at(const char* where, const std::string& what) const {
  fail(file_.source, where, what);
}

void SceneFields::fail_value(const SceneField& field, std::string_view value,
                             const std::string& what) const {
  fail_at(file_.xml ? field.where : value.data(), what);
}

void SceneFields::fail_field(const SceneNode& node, const SceneField& field) const {
  fail_at(field.where,
          "the field " + in_quotes(field.name) + " of " + std::string(node.type) +
              (field.nodes.empty() ? "" : ", with " + in_quotes(field.nodes[0]->type)) +
              ", is not known and might hold geometry; export without it");
}

double SceneFields::number(const SceneField& field, std::string_view value) const {
  if (value.empty()) fail_at(field.where, in_quotes(field.name) + " has too few numbers");
  const std::optional<double> x = to_double(value);
  if (!x || !std::isfinite(*x))
    fail_value(field, value,
               in_quotes(value) + (x ? " is not a finite double; repair or remove it"
                                     : " is not a number; check that the file is complete"));
  return *x;
}

std::int64_t SceneFields::integer(const SceneField& field, std::string_view value) const {
  std::int64_t number = 0;
  std::string_view digits = value;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size())
    fail_value(field, value,
               in_quotes(value) + " where an integer is expected; the file is damaged");
  return number;
}

bool SceneFields::read_bool(const SceneField& field) const {
  std::string_view text = field.text;
  const std::string_view value = next_value(text);
  const bool yes = value == "TRUE" || value == "true";
  if ((!yes && value != "FALSE" && value != "false") || !next_value(text).empty())
    fail_at(field.where, in_quotes(field.name) + " is neither true nor false");
  return yes;
}

std::vector<std::int64_t> SceneFields::read_integers(const SceneField& field) const {
  std::vector<std::int64_t> values;
  std::string_view text = field.text;
  for (auto v = next_value(text); !v.empty(); v = next_value(text))
    values.push_back(integer(field, v));
  return values;
}

std::string_view SceneFields::single(const SceneField& field) const {
  std::string_view text = field.text;
  const std::string_view value = next_value(text);
  if (value.empty() || !next_value(text).empty())
    fail_at(field.where, in_quotes(field.name) + " has not one value");
  return value;
}

const SceneNode* SceneFields::only(const SceneField& field) const {
  if (field.nodes.size() > 1)
    fail_at(field.where, in_quotes(field.name) + " has several nodes; the file is damaged");
  if (field.nodes.empty() && !field.text.empty())
    fail_at(field.where, in_quotes(field.name) + " has no node; the file is damaged");
  return field.nodes.empty() ? nullptr : field.nodes[0];
}

bool SceneFields::read_common(const SceneField& field) const {
  if (field.name == "metadata") {
    constexpr std::array<std::string_view, 6> kMetadata = {"MetadataBoolean", "MetadataDouble",
                                                           "MetadataFloat",   "MetadataInteger",
                                                           "MetadataSet",     "MetadataString"};
    for (const SceneNode* const n : field.nodes)
      if (!contains(kMetadata, n->type))
        fail_at(n->where, in_quotes(n->type) + " where metadata is expected");
    return true;
  }
  if (field.name != "visible") return false;
  std::string_view text = field.text;
  copier_.spend(text);
  for (auto v = next_value(text); !v.empty(); v = next_value(text))
    if (v != "TRUE" && v != "true")
      fail_at(field.where, "nodes that are not visible are not supported; delete them");
  return true;
}

}  // namespace kaboum::io
