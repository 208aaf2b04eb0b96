#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "job.h"

namespace kaboum::batch {

using Clock = std::chrono::steady_clock;

/// @param programs  BatchRequest::programs
/// @return the program's path, or its name, which is on PATH then
std::string find_program(const std::string& name, const fs::path& programs);

/// Starts a program with nothing on standard input, its output discarded and its messages in a
/// file. It ends when the thread that started it does, however that ends.
/// @param most_memory  of address space; 0: no limit [bytes]
/// @return its id @throws Error{LimitReached} when no process can be made
pid_t start(const std::vector<std::string>& command, const fs::path& messages,
            std::uintmax_t most_memory);

/// How a process ended.
struct Ended {
  pid_t id = 0;
  int exit_code = -1;  ///< -1: by a signal
  int signal = 0;
  double cpu_seconds = 0, peak_megabytes = 0;
};

/// A descriptor that can be read once the process has ended, to be closed; -1: the system has none.
int watched(pid_t id);

/// How a process of ours ended; nullopt: it has not. One that somebody else has waited for counts
/// as stopped.
std::optional<Ended> end_of(pid_t id);

/// The last line that is not empty, of a program's messages, shortened.
std::string last_line(const fs::path& messages);

}  // namespace kaboum::batch
