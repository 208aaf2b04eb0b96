#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kaboum::scene {

using Json = nlohmann::ordered_json;

/// JSON as YAML that people like to read: a line for each member, lists of numbers on one line,
/// strings in quotation marks.
std::string to_yaml(const Json& json);

}  // namespace kaboum::scene
