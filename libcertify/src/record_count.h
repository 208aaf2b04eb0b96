#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

namespace kaboum::certify {

/// A count in a record. @throws nlohmann::json::exception where there is none: `get` would convert
/// any number.
inline std::size_t count_at(const nlohmann::ordered_json& record, const char* name) {
  return record.at(name).get_ref<const nlohmann::ordered_json::number_unsigned_t&>();
}

}  // namespace kaboum::certify
