#pragma once

#include <kaboum/base/processor.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace kaboum::collide::detail {

constexpr std::size_t kBoxesAtOnce = 8;

/// Ends of many boxes, axis by axis. kBoxesAtOnce - 1 numbers behind the last one may be read.
struct BoxRows {
  std::array<const float*, 3> low, high;
};

/// The fourth numbers are of no use.
struct FloatBox {
  float low[4] = {}, high[4] = {};
};

/// Bit k is set for boxes from + k that meet a box, which touching ones do.
/// @param count  of boxes looked at, 64 at most
/// @param wide   whether eight are looked at at once, else one. @pre has_avx2() where it is
std::uint64_t meeting_boxes(const BoxRows& rows, std::size_t from, std::size_t count,
                            const FloatBox& box, bool wide = has_avx2());

}  // namespace kaboum::collide::detail
