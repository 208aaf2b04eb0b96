#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kaboum {

/// A loop by std::thread: parts are handed out in turn, so that any two of them may run at once.
/// Loops within a part run on its thread.
inline void thread_loop(std::size_t n, std::size_t grain, bool alone,
                        const std::function<void(std::size_t, std::size_t)>& body,
                        std::size_t threads) {
  thread_local bool inside = false;
  if (n == 0) return;
  if (inside || threads < 2 || n <= grain) return body(0, n);
  const std::size_t part = alone ? 1 : std::max(grain, n / (4 * threads) + 1);
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto work = [&] {
    inside = true;
    try {
      for (;;) {
        const std::size_t begin = next.fetch_add(part);
        if (begin >= n) break;
        body(begin, std::min(n, begin + part));
      }
    } catch (...) {
      next = n;
      const std::scoped_lock lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
    inside = false;
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < std::min(threads, (n + part - 1) / part); ++i)
    others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace kaboum
