#pragma once

#include <cstring>

namespace kaboum::collide::detail {

/// Two bodies at once.
using Two [[gnu::vector_size(16)]] = double;

/// Numbers of many bodies, two from any place on.
struct Twos {
  const double* from;
  Two operator[](std::size_t i) const {
    Two out;
    std::memcpy(&out, from + i, sizeof out);
    return out;
  }
};

}  // namespace kaboum::collide::detail
