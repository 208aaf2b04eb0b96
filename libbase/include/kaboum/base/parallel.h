#pragma once

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_group.h>

#include <utility>

namespace kaboum {

// TBB's loops, none of which is cut short because of what happens elsewhere. A loop of TBB's own
// belongs to the group of tasks it is called from: where a sibling there throws, all loops within
// end at once, without an exception, and what they leave undone is unspecified. A task that called
// such a loop would go on with half a hierarchy, and what it claims would be proved by nothing.
// These end when all is done, or throw what one of their own tasks has thrown.

/// Calls body(i) for all i from first to last, without last, or body(range) for parts of a range.
/// The arguments are those of tbb::parallel_for, without a context.
template <class... Arguments>
void parallel_loop(Arguments&&... arguments) {
  tbb::task_group_context alone(tbb::task_group_context::isolated);
  tbb::parallel_for(std::forward<Arguments>(arguments)..., alone);
}

/// Calls all of them.
template <class... Functions>
void parallel_calls(Functions&&... functions) {
  tbb::task_group_context alone(tbb::task_group_context::isolated);
  tbb::parallel_invoke(std::forward<Functions>(functions)..., alone);
}

}  // namespace kaboum
