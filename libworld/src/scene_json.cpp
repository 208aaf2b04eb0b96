// Scenes as JSON, whatever they are written in.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/world/scene.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "located_json.h"

namespace kaboum::world {
namespace {

using detail::Located;
using Json = nlohmann::ordered_json;

Json json_of(const Located& value) {
  switch (value.kind) {
    case Located::Kind::Null:
      return nullptr;
    case Located::Kind::Boolean:
      return value.boolean;
    case Located::Kind::Number:
      if (std::abs(value.number) < 1e15 && value.number == std::floor(value.number) &&
          !(value.number == 0 && std::signbit(value.number)))
        return static_cast<std::int64_t>(value.number);
      return value.number;
    case Located::Kind::String:
      return value.text;
    case Located::Kind::Array: {
      Json out = Json::array();
      for (const Located& item : value.items) out.push_back(json_of(item));
      return out;
    }
    default: {
      Json out = Json::object();
      for (std::size_t i = 0; i < value.names.size(); ++i)
        out[value.names[i]] = json_of(value.values[i]);
      return out;
    }
  }
}

}  // namespace

std::string scene_as_json(std::string_view text, const std::string& name) {
  if (!detail::is_yaml(name)) {
    if (is_nested_too_deep(text))
      throw Error(ErrorCode::InvalidInput, name + ": " + describe_json_depth());
    return std::string(text);
  }
  return json_of(detail::parse_located_yaml(text, name)).dump();
}

}  // namespace kaboum::world
