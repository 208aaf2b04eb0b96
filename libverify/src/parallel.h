#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_sort.h>
#include <oneapi/tbb/task_group.h>

#include <utility>

namespace kaboum::verify {

// TBB's loops, in groups of their own: a loop of TBB's is left undone without a word where another
// task of the caller's group throws, and an answer given then would rest on nothing. Nothing is
// shared with the libraries that are checked, this neither.

template <class... Arguments>
void parallel_loop(Arguments&&... arguments) {
  oneapi::tbb::task_group_context alone(oneapi::tbb::task_group_context::isolated);
  oneapi::tbb::parallel_for(std::forward<Arguments>(arguments)..., alone);
}

template <class... Functions>
void parallel_calls(Functions&&... functions) {
  oneapi::tbb::task_group_context alone(oneapi::tbb::task_group_context::isolated);
  oneapi::tbb::parallel_invoke(std::forward<Functions>(functions)..., alone);
}

template <class Iterator, class Compare>
void sort_in_parallel(Iterator begin, Iterator end, const Compare& compare) {
  oneapi::tbb::task_group_context alone(oneapi::tbb::task_group_context::isolated);
  oneapi::tbb::task_group group(alone);
  group.run_and_wait([&] { oneapi::tbb::parallel_sort(begin, end, compare); });
}

}  // namespace kaboum::verify
