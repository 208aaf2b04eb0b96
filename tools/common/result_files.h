#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

/// Files of one result or of a series.
namespace kaboum::tools {

/// Calls the functions in order, each of which writes the file of its name (an empty name: none).
/// If one throws, the files written before are taken back.
void write_together(const std::vector<std::pair<std::string, std::function<void()>>>& files);

/// The file of each level: `name` with {vertices} replaced by its number.
/// @throws Error{InvalidArgument} when there are several levels and no {vertices}, or the other way
///   round none.
std::vector<std::string> level_files(const std::string& name,
                                     const std::vector<std::size_t>& counts);

}  // namespace kaboum::tools
