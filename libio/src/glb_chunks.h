#pragma once

#include <cstdint>

/// The binary container of glTF 2.0: a header and two chunks, whose words are little-endian.
namespace kaboum::io {

inline constexpr std::uint32_t kGlbMagic = 0x46546C67;     // "glTF"
inline constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
inline constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"

}  // namespace kaboum::io
