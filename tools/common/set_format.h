#pragma once

#include <kaboum/io/convex_io.h>

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// The option --output-format of tools that write convex sets: glb, obj or stl-folder.
void add_set_format_option(CLI::App& app, std::string& format);

/// The format that --output-format names, else that of the path.
/// @throws Error{InvalidArgument} when there is none, and for a folder on standard output.
io::SetFormat set_format_for(const std::string& path, const std::string& format);

}  // namespace kaboum::tools
