#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "job.h"

/// What jobs make: files, or folders of robots.
namespace kaboum::batch {

/// Of a file, or of all files in a folder; 0: there is none. [bytes]
std::uintmax_t size_of(const fs::path& result);

/// SHA-256 of a file; of a folder that of its files' names and hashes, in the order of the names.
/// Empty: there is none, or it cannot be read.
std::string digest_of(const fs::path& result);

/// What tells whether a program has written a result, though the bytes be the same: of a file, its
/// state; of a folder, those of the robots in it. Empty: there is none.
std::vector<FileState> marks_of(const fs::path& result);

/// @throws Error{OutputFailed}
void move(const fs::path& from, const fs::path& to);

}  // namespace kaboum::batch
