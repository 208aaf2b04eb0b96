#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace kaboum::io {

/// Whether `name` is one of `names`.
template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace kaboum::io
