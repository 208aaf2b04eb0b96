#pragma once

#include <filesystem>

namespace kaboum {

/// The file of the program or library that holds an address, whatever the current folder and the
/// name by which it was called; empty where that is not known.
/// @param address  of a function or a constant of it
std::filesystem::path program_file(const void* address);

}  // namespace kaboum
