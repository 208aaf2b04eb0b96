#pragma once

#include <cstddef>
#include <functional>
#include <utility>

namespace kaboum {

// Loops by several threads, as many as tbb::global_control allows. Each ends when all is done, or
// throws what one of its calls has thrown, the first to be caught; calls that have not begun by
// then are left out. docs/architecture.md, "Parallel loops", says why TBB's own are not called.

/// Order in which the indices of a loop are handed out.
struct LoopParts {
  std::size_t grain = 1;  ///< no part of several threads' is smaller, but for the last ones
  bool alone = false;     ///< every index by itself: for calls that take long, or unequally long
};

/// Calls body(begin, end) for parts of 0 … n, without n, that together are all of it.
void parallel_ranges(std::size_t n, LoopParts parts,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body(i) for all i from first to last, without last.
template <class Index, class Body>
void parallel_for(Index first, Index last, Body&& body, LoopParts parts = {}) {
  if (!(first < last)) return;
  const auto calls = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i)
      body(static_cast<Index>(first + static_cast<Index>(i)));
  };
  parallel_ranges(static_cast<std::size_t>(last - first), parts, std::cref(calls));
}

/// The same for little work each: in parts of at least 16384.
template <class Body>
void parallel_for_light(std::size_t n, Body&& body) {
  parallel_for(std::size_t{0}, n, std::forward<Body>(body), {.grain = 16384});
}

/// Calls both.
void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace kaboum
