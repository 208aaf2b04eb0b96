// SHA-256 (FIPS 180-4).

#include <kaboum/base/sha256.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "sha256_blocks.h"

namespace kaboum {
namespace detail {

/// Eight rounds at a time: the words change their roles instead of moving.
void sha256_portable(Sha256State& state, const char* blocks, std::size_t count) {
  for (; count > 0; --count, blocks += kSha256Block) {
    std::array<std::uint32_t, 64> w;
    for (std::size_t t = 0; t < 16; ++t) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4; ++k)
        word = word << 8U | static_cast<unsigned char>(blocks[4 * t + k]);
      w[t] = word;
    }
    for (std::size_t t = 16; t < 64; ++t) {
      const std::uint32_t x = w[t - 15], y = w[t - 2];
      w[t] = w[t - 16] + (std::rotr(x, 7) ^ std::rotr(x, 18) ^ (x >> 3U)) + w[t - 7] +
             (std::rotr(y, 17) ^ std::rotr(y, 19) ^ (y >> 10U));
    }
    auto [a, b, c, d, e, f, g, h] = state;
    const auto round = [&w](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t& s,
                            std::uint32_t u, std::uint32_t v, std::uint32_t x, std::uint32_t& y,
                            std::size_t t) {
      y += (std::rotr(u, 6) ^ std::rotr(u, 11) ^ std::rotr(u, 25)) + (x ^ (u & (v ^ x))) +
           kSha256Round[t] + w[t];
      s += y;
      y += (std::rotr(p, 2) ^ std::rotr(p, 13) ^ std::rotr(p, 22)) + ((p & q) | (r & (p | q)));
    };
    for (std::size_t t = 0; t < 64; t += 8) {
      round(a, b, c, d, e, f, g, h, t);
      round(h, a, b, c, d, e, f, g, t + 1);
      round(g, h, a, b, c, d, e, f, t + 2);
      round(f, g, h, a, b, c, d, e, t + 3);
      round(e, f, g, h, a, b, c, d, t + 4);
      round(d, e, f, g, h, a, b, c, t + 5);
      round(c, d, e, f, g, h, a, b, t + 6);
      round(b, c, d, e, f, g, h, a, t + 7);
    }
    const Sha256State added = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < state.size(); ++i) state[i] += added[i];
  }
}

}  // namespace detail

std::string sha256(std::span<const char> bytes) {
  using detail::kSha256Block;
  detail::Sha256State state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                               0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  const auto compress =
      detail::has_sha256_instructions() ? detail::sha256_by_processor : detail::sha256_portable;
  const std::size_t whole = bytes.size() / kSha256Block, rest = bytes.size() % kSha256Block;
  compress(state, bytes.data(), whole);

  // The rest, a one bit, zeros, and the length in bits: one block or two.
  std::array<char, 2 * kSha256Block> tail{};
  std::copy_n(bytes.end() - static_cast<std::ptrdiff_t>(rest), rest, tail.begin());
  tail[rest] = static_cast<char>(0x80);
  const std::size_t blocks = rest + 9 <= kSha256Block ? 1 : 2;
  const std::uint64_t bits = 8 * std::uint64_t{bytes.size()};
  for (std::size_t i = 0; i < 8; ++i)
    tail[blocks * kSha256Block - 1 - i] = static_cast<char>(bits >> (8 * i));
  compress(state, tail.data(), blocks);

  std::string hex;
  hex.reserve(64);
  for (const std::uint32_t word : state)
    for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[(word >> shift) & 15U];
  return hex;
}

}  // namespace kaboum
