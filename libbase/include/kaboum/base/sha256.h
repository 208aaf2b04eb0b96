#pragma once

#include <span>
#include <string>

namespace kaboum {

/// SHA-256 (FIPS 180-4) of the bytes, as 64 lower-case hexadecimal digits. By the processor's own
/// instructions where it has them.
std::string sha256(std::span<const char> bytes);

}  // namespace kaboum
