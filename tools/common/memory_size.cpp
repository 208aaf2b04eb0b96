// Sizes of memory as options state them.

#include "memory_size.h"

#include <kaboum/base/error.h>

namespace kaboum::tools {

std::size_t parse_memory(const std::string& text, const char* option) {
  if (text.empty()) return 0;
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  double unit = 1;
  if (used > 0 && used + 1 == text.size()) {
    const std::string units = "kKMG";
    const std::size_t at = units.find(text[used]);
    unit = at == std::string::npos ? 0 : at <= 1 ? 1024.0 : at == 2 ? 1048576.0 : 1073741824.0;
    ++used;
  }
  const double bytes = value * unit;
  if (used != text.size() || !(bytes >= 1) || bytes > 1e15)
    throw Error(ErrorCode::InvalidArgument,
                std::string(option) + ": expected a size such as 500M or 2G");
  return static_cast<std::size_t>(bytes);
}

}  // namespace kaboum::tools
