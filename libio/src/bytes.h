#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace kaboum::io {

/// A value from unaligned bytes of the given order.
template <typename T>
T load(const char* from, std::endian order) {
  std::array<char, sizeof(T)> raw;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    raw[i] = from[order == std::endian::native ? i : sizeof(T) - 1 - i];
  return std::bit_cast<T>(raw);
}

template <typename T>
T load_little(const char* from) {
  return load<T>(from, std::endian::little);
}

/// Grows a byte vector by little-endian values and by text.
class Output {
 public:
  void reserve(std::size_t size) { bytes_.reserve(size); }

  template <typename T>
  void little(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  void text(std::string_view s);

  /// The shortest digits that give the same value back (float's own digits for a float).
  template <typename T>
  void number(T value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    bytes_.insert(bytes_.end(), digits.data(), end);
  }

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  std::vector<char> take() { return std::move(bytes_); }

 private:
  std::vector<char> bytes_;
};

}  // namespace kaboum::io
