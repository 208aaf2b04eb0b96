#pragma once

#include <kaboum/base/parallel.h>

#include <tbb/blocked_range.h>

#include <cstddef>

namespace kaboum::bmesh {

/// Calls visit(i) for all i < n, in any order and by several threads; for little work each.
template <class Visit>
void in_parallel(std::size_t n, Visit&& visit) {
  constexpr std::size_t kGrain = 16384;
  if (n <= kGrain) {
    for (std::size_t i = 0; i < n; ++i) visit(i);
    return;
  }
  parallel_loop(tbb::blocked_range<std::size_t>(0, n, kGrain),
                [&](const tbb::blocked_range<std::size_t>& range) {
                  for (std::size_t i = range.begin(); i != range.end(); ++i) visit(i);
                });
}

}  // namespace kaboum::bmesh
