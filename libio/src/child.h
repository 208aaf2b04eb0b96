#pragma once

#include <kaboum/io/child_process.h>
#include <kaboum/io/mesh_io.h>

#include <functional>

#include "source.h"

namespace kaboum::io {

/// Calls `read` in a child process with limited memory and CPU time, and returns what it returned.
///
/// For readers that are not ours: whatever they do to their memory, this process is left alone. An
/// Error that `read` throws is thrown here again.
///
/// @throws Error{InvalidInput} when the child crashes, aborts or reaches a limit, naming the file.
/// @throws Error{LimitReached} when no process can be started.
ReadResult read_in_child(const Source& source, const ChildLimits& limits,
                         const std::function<ReadResult()>& read);

}  // namespace kaboum::io
