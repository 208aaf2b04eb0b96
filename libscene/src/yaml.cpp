// YAML 1.2, of what JSON can say. Scalars and quoted strings are written as JSON writes them, which
// is YAML as well.

#include "yaml.h"

#include <algorithm>

namespace kaboum::scene {
namespace {

bool is_short(const Json& json) {
  return !json.is_structured() || json.empty() ||
         (json.is_array() && std::none_of(json.begin(), json.end(),
                                          [](const Json& item) { return item.is_structured(); }));
}

std::string key_of(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  // Words that some programs read as true or false are written in quotation marks, like numbers.
  const bool plain = name.size() > 3 && std::all_of(name.begin(), name.end(), is_plain) &&
                     !(name[0] >= '0' && name[0] <= '9') && name != "true" && name != "false" &&
                     name != "null" && name != "True" && name != "TRUE" && name != "False" &&
                     name != "FALSE" && name != "Null" && name != "NULL";
  return plain ? name : Json(name).dump();
}

void append(std::string& out, const Json& json, std::size_t depth) {
  const std::string indent(2 * depth, ' ');
  bool first = true;
  const auto begin_line = [&] {
    // The first member of a list's item follows its dash.
    if (!first || out.empty() || out.back() == '\n') out += indent;
    first = false;
  };
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) {
      begin_line();
      out += key_of(name) + ":";
      if (is_short(value)) {
        out += " " + value.dump() + "\n";
      } else {
        out += "\n";
        append(out, value, depth + 1);
      }
    }
    return;
  }
  for (const Json& value : json) {
    begin_line();
    out += "- ";
    if (is_short(value))
      out += value.dump() + "\n";
    else
      append(out, value, depth + 1);
  }
}

}  // namespace

std::string to_yaml(const Json& json) {
  if (is_short(json)) return json.dump() + "\n";
  std::string out;
  append(out, json, 0);
  return out;
}

}  // namespace kaboum::scene
