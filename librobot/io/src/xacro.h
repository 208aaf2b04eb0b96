#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kaboum::robot {

/// Arguments of a xacro file, NAME:=VALUE each.
using XacroArguments = std::vector<std::string>;

/// What the program `xacro` may use.
struct XacroLimits {
  std::uint64_t seconds = 60;                       ///< of CPU time, and twice as long by the clock
  std::uint64_t memory = std::uint64_t{2} << 30U;   ///< addresses; no limit with sanitizers [bytes]
  std::uint64_t output = std::uint64_t{64} << 20U;  ///< [bytes]
};

/// What `xacro FILE NAME:=VALUE ...` makes of a file: run as a process of its own, found on PATH.
/// Its name as it is given, which xacro writes into a comment, in the folder of this process, as a
/// shell would call it; one that begins with "-" as ./NAME.
///
/// @throws Error{InvalidInput} when it is not on PATH, fails, is ended by a signal, or reaches a
///   limit; naming the file and what it said last. Also where the path has ":=" in it, which xacro
///   takes for an argument's value.
/// @throws Error{InvalidArgument} for an argument that is not NAME:=VALUE.
/// @throws Error{LimitReached} when no process can be started.
/// @param packages  folders that $(find NAME) is looked up in, as packages of meshes are; what is
///   found nowhere is named in the message where xacro fails
std::string expand_xacro(const std::filesystem::path& file, const XacroArguments& arguments = {},
                         const XacroLimits& limits = {},
                         const std::vector<std::string>& packages = {});

/// The files that it includes, sorted, as `xacro --deps FILE` prints them: with blanks between them
/// and in them, so that as many words are taken for a name as it takes to be that of a file.
/// @throws as expand_xacro; Error{InvalidInput} where words are left.
std::vector<std::string> xacro_includes(const std::filesystem::path& file,
                                        const XacroArguments& arguments = {},
                                        const XacroLimits& limits = {},
                                        const std::vector<std::string>& packages = {});

}  // namespace kaboum::robot
