// Loops by several threads. By oneTBB, in groups of their own: a loop of TBB's is left undone
// without a word where another task of the caller's group throws, and an answer given then would
// rest on nothing. With KABOUM_STD_THREADS by std::thread, for ThreadSanitizer, which does not see
// what orders tasks inside TBB's binary.

#include "parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_group.h>

#ifdef KABOUM_STD_THREADS
#include "thread_loop.h"
#endif

namespace kaboum::verify {

namespace tbb = oneapi::tbb;

#ifdef KABOUM_STD_THREADS

void parallel_ranges(std::size_t n, const std::function<void(std::size_t, std::size_t)>& body) {
  thread_loop(n, body,
              tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
  parallel_for(0, 2, [&](int i) { i == 0 ? first() : second(); });
}

#else

void parallel_ranges(std::size_t n, const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, n),
      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); }, own);
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_invoke(first, second, own);
}

#endif

}  // namespace kaboum::verify
