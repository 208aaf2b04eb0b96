// The format of a set of bodies: by option, or by the name of the output.

#include "set_format.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <map>

namespace kaboum::tools {

void add_set_format_option(CLI::App& app, std::string& format) {
  app.add_option("--output-format", format, "Format of the result [by extension]")
      ->check(CLI::IsMember({"glb", "obj", "stl-folder"}).description(""))
      ->type_name("glb|obj|stl-folder");
}

io::SetFormat set_format_for(const std::string& path, const std::string& format) {
  static const std::map<std::string, io::SetFormat> kFormats{
      {"glb", io::SetFormat::Glb},
      {"obj", io::SetFormat::Obj},
      {"stl-folder", io::SetFormat::Directory}};
  std::optional<io::SetFormat> found;
  if (!format.empty()) {
    found = kFormats.at(format);
  } else if (path == "-") {
    throw Error(ErrorCode::InvalidArgument, "--output-format is needed with '-': glb or obj");
  } else {
    found = io::set_format_from_path(path);
  }
  if (!found)
    throw Error(ErrorCode::InvalidArgument,
                path +
                    ": unknown extension; use .glb, .obj or the name of a folder, or give "
                    "--output-format");
  if (path.ends_with('/') && *found != io::SetFormat::Directory)
    throw Error(ErrorCode::InvalidArgument, path + ": name a file, not a folder");
  if (path == "-" && *found == io::SetFormat::Directory)
    throw Error(ErrorCode::InvalidArgument, "a folder cannot be written to stdout; use glb or obj");
  return *found;
}

}  // namespace kaboum::tools
