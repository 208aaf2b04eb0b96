#pragma once

#include <oneapi/tbb/parallel_sort.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>

namespace kaboum::verify {

/// std::sort by several threads, in a group of tasks of its own (parallel.cpp says why).
template <class Iterator, class Compare>
void sort_in_parallel(Iterator begin, Iterator end, const Compare& compare) {
#ifdef KABOUM_STD_THREADS
  std::sort(begin, end, compare);
#else
  oneapi::tbb::task_group_context own(oneapi::tbb::task_group_context::isolated);
  oneapi::tbb::task_group group(own);
  group.run_and_wait([&] { oneapi::tbb::parallel_sort(begin, end, compare); });
#endif
}

}  // namespace kaboum::verify
