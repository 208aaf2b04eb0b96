#pragma once

#include <cstddef>
#include <functional>

namespace kaboum::verify {

// Loops by several threads that end when all is done, or throw. A copy of what the libraries that
// are checked have (kaboum/base/parallel.h), of which nothing is shared.

/// Calls body(begin, end) for parts of 0 … n, without n, that together are all of it.
void parallel_ranges(std::size_t n,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body(i) for all i from first to last, without last.
template <class Index, class Body>
void parallel_for(Index first, Index last, Body&& body) {
  if (!(first < last)) return;
  const auto calls = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i)
      body(static_cast<Index>(first + static_cast<Index>(i)));
  };
  parallel_ranges(static_cast<std::size_t>(last - first), std::cref(calls));
}

/// Calls both.
void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace kaboum::verify
