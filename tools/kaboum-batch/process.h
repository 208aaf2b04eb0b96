#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "job.h"

namespace kaboum::batch {

using Clock = std::chrono::steady_clock;

/// Where programs are looked for first: beside this one.
/// @return the program's path, or its name, which is on PATH then
std::string find_program(const std::string& name);

/// Starts a program with nothing on standard input, its output discarded and its messages in a
/// file. It ends when this process does, however that ends.
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

/// The next process that has ended; id 0: none has yet.
Ended next_ended();

/// The last line that is not empty, of a program's messages, shortened.
std::string last_line(const fs::path& messages);

}  // namespace kaboum::batch
