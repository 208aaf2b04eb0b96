#pragma once

#include <kaboum/base/processor.h>
#include <kaboum/geom/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace kaboum::collide::detail {

/// Ends of many boxes, axis by axis.
struct BoxRows {
  std::array<const double*, 3> low, high;
};

/// Bit k is set for boxes from + k that meet a box, which touching ones do.
/// @param count  of boxes looked at, 64 at most
/// @param wide   whether four are looked at at once, else one. @pre has_avx2() where it is
std::uint64_t meeting_boxes(const BoxRows& rows, std::size_t from, std::size_t count,
                            const geom::Box3& box, bool wide = has_avx2());

}  // namespace kaboum::collide::detail
