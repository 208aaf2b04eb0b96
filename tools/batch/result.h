#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "job.h"

/// What jobs make: files, or folders of robots.
namespace kaboum::batch {

/// Of a file, or of all files in a folder; 0: there is none. [bytes]
std::uintmax_t size_of(const fs::path& result);

/// SHA-256 of a file; of a folder that of its files' names and hashes, in the order of the names.
/// Empty: there is none, or it cannot be read.
std::string digest_of(const fs::path& result);

/// Whether there is a result: of a folder, its robot.
bool is_there(const Job& job, const fs::path& result);

/// Takes away what an earlier run with other options, or of another input, has left: a file; of a
/// robot's folder the robot, whose bodies mean nothing without it.
void remove_result(const Job& job, const fs::path& result);

/// @throws Error{OutputFailed}
void move(const fs::path& from, const fs::path& to);

}  // namespace kaboum::batch
