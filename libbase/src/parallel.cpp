// Loops by several threads. By oneTBB, in groups of their own: a loop of TBB's belongs to the group
// of tasks it is called from, and where a sibling there throws, all loops within end at once,
// without an exception; what they leave undone is unspecified. A task that called such a loop would
// go on with half a hierarchy, and what it claims would be proved by nothing.
//
// With KABOUM_STD_THREADS by std::thread, for ThreadSanitizer, which does not see what orders tasks
// inside TBB's binary.

#include <kaboum/base/parallel.h>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_group.h>

#ifdef KABOUM_STD_THREADS
#include "thread_loop.h"
#endif

namespace kaboum {

#ifdef KABOUM_STD_THREADS

void parallel_ranges(std::size_t n, LoopParts parts,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  thread_loop(n, parts.grain, parts.alone, body,
              tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
  parallel_for(0, 2, [&](int i) { i == 0 ? first() : second(); });
}

#else

void parallel_ranges(std::size_t n, LoopParts parts,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  if (n <= parts.grain) {
    if (n > 0) body(0, n);
    return;
  }
  tbb::task_group_context own(tbb::task_group_context::isolated);
  const tbb::blocked_range<std::size_t> all(0, n, parts.grain);
  const auto calls = [&](const tbb::blocked_range<std::size_t>& range) {
    body(range.begin(), range.end());
  };
  if (parts.alone)
    tbb::parallel_for(all, calls, tbb::simple_partitioner(), own);
  else
    tbb::parallel_for(all, calls, own);
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_invoke(first, second, own);
}

#endif

}  // namespace kaboum
