#pragma once

#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

/// Files that a command line names: their formats, and whether they can be written.
namespace kaboum::tools {

/// Whether there is a folder of that name; false where that cannot be told.
bool is_folder(const std::filesystem::path& path);

/// Format named by --input-format/--output-format, else by the file name's extension.
/// @throws Error{InvalidArgument} when unknown.
io::Format format_for(const std::string& path, const std::string& name, const char* option);

/// What a user says about the format of meshes that are read.
struct InputFormat {
  std::string name;      ///< empty: by the files' extensions
  std::string importer;  ///< of formats that have no reader here; empty: none

  /// nullopt: by the files' extensions.
  [[nodiscard]] std::optional<io::Format> stated() const;
};

/// Adds --input-format and --importer. @param text  of the former
void add_input_format(CLI::App& app, InputFormat& format, const std::string& text);

/// @throws Error as the one above, and as io::format_of_file
io::Format format_for(const std::string& path, const InputFormat& format);

/// Refuses to write a file twice, over an input, or into a folder that does not exist or cannot be
/// looked into; outputs are (option, file), empty files are none. With a --depfile, --output,
/// --progressive and the inputs must have names that can be in it.
/// @throws Error{InvalidArgument}, Error{OutputFailed}
void require_apart(const std::vector<std::pair<std::string, std::string>>& outputs,
                   const std::vector<std::string>& inputs);

/// Whether the names can be written in a rule of make as GNU make and ninja read them; of a
/// dependency file of the name *.list, any can.
/// @throws Error{InvalidArgument} naming the one that cannot
void require_depfile(const std::string& path, const std::vector<std::string>& targets,
                     const std::vector<std::string>& inputs);

/// A Makefile rule saying that the targets (empty names are none) depend on `inputs`, each listed
/// once. If the name ends in .list: the inputs, each followed by a zero byte.
/// @throws Error{InvalidArgument} as require_depfile
void write_depfile(const std::string& path, const std::vector<std::string>& targets,
                   const std::vector<std::string>& inputs);

}  // namespace kaboum::tools
