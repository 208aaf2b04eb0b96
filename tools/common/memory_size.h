#pragma once

#include <cstddef>
#include <string>

namespace kaboum::tools {

/// "500M", "2G", "1000": bytes; k, K, M and G are powers of 1024. Empty: 0.
/// @throws Error{InvalidArgument} naming the option
std::size_t parse_memory(const std::string& text, const char* option);

}  // namespace kaboum::tools
