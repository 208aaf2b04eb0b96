#pragma once

#include <cstddef>
#include <string>

namespace kaboum {

/// "1 body", "2 bodies".
inline std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

}  // namespace kaboum
