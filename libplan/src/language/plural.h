#pragma once

#include <string>

namespace kaboum::plan {

/// "1 argument", "2 arguments".
inline std::string plural(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

}  // namespace kaboum::plan
