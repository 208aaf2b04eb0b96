#pragma once

#include <cstdint>

namespace kaboum::plan {

/// Knowledge of one ground atom, as stored: two bits.
enum class AtomKnowledge : std::uint8_t { Unknown = 0, True = 1, False = 2, Whether = 3 };

}  // namespace kaboum::plan
