#pragma once

#include <kaboum/base/work.h>

namespace kaboum::bmesh {

/// Counts where somebody asks for it.
inline void count(Work* work, std::uint64_t steps) {
  if (work != nullptr) work->add(steps);
}

// Shares of the work allowed, after which parts of a decimation end, so that the others have time.
// tests/bmesh/work_test.cpp holds that what is left suffices for a result.

/// No second decimation of small meshes is begun.
constexpr double kNoneBegins = 0.3;
/// No vertex is pulled back any more, costs are not measured, and a second decimation is given up.
constexpr double kNoneMoves = 0.6;
/// No edge is contracted.
constexpr double kNoneContracts = 1;

}  // namespace kaboum::bmesh
