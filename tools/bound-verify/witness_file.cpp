// Triangles that witness a refuted claim, as a mesh file.

#include "witness_file.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>

namespace kaboum::tools {
namespace {

std::optional<io::Format> format_of(const std::string& path) {
  return io::format_from_name(std::filesystem::path(path).extension().string());
}

}  // namespace

void require_witness_format(const std::string& path) {
  if (path.empty()) return;
  const auto format = format_of(path);
  if (!format || !(io::holds_double(*format) || *format == io::Format::Stl))
    throw Error(ErrorCode::InvalidArgument, "--witness: write .ply, .obj, .off or .stl (as text)");
}

void write_witness(const std::string& path, const geom::Mesh& mesh, const std::string& comment) {
  io::WriteOptions options;
  options.double_precision = true;
  options.comment = comment;
  io::Format format = *format_of(path);
  if (format == io::Format::Stl) format = io::Format::StlAscii;  // holds doubles
  io::write_file(path, io::serialise_mesh(geom::Mesh(mesh), format, options));
}

}  // namespace kaboum::tools
