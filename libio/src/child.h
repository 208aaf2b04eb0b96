#pragma once

#include <kaboum/io/mesh_io.h>

#include <functional>

#include "source.h"

namespace kaboum::io {

/// What a child process may use.
struct ChildLimits {
  std::uint64_t memory;   ///< bytes besides what the process has already; no limit with sanitizers
  std::uint64_t seconds;  ///< of CPU time
};

/// 1 GiB and 256 times the file's size, 20 s and 5 s per MiB.
ChildLimits child_limits(std::uint64_t file_size);

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
