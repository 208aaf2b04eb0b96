#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace kaboum::io {

/// Limits of a child process.
struct ChildLimits {
  std::uint64_t memory;   ///< bytes besides what the process has already; no limit with sanitizers
  std::uint64_t seconds;  ///< of CPU time
};

/// 1 GiB and 256 times the file's size, 20 s and 5 s per MiB.
ChildLimits child_limits(std::uint64_t file_size);

/// Calls `work` in a child process with limited memory and CPU time, and returns what it returned.
///
/// For code that is not ours and looks at files: whatever it does to its memory, this process is
/// left alone. An Error that `work` throws is thrown here again.
///
/// @param name  of the file, for messages.
/// @throws Error{InvalidInput} when the child crashes, aborts or reaches a limit, naming the file.
/// @throws Error{LimitReached} when no process can be started.
std::string bytes_of_child(const std::string& name, const ChildLimits& limits,
                           const std::function<std::string()>& work);

}  // namespace kaboum::io
