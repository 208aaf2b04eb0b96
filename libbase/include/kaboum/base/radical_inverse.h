#pragma once

#include <cstddef>
#include <cstdint>

namespace kaboum {

/// The digits of i in a base, mirrored at the point, in [0, 1): numbers of van der Corput's
/// sequence and, with the prime numbers as bases, of Halton's.
/// @pre base ≥ 2
inline double radical_inverse(std::size_t i, std::uint32_t base) {
  double out = 0, digit = 1;
  for (; i > 0; i /= base) {
    digit /= base;
    out += digit * static_cast<double>(i % base);
  }
  return out;
}

}  // namespace kaboum
