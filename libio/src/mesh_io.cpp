// Meshes from files and to files: which format it is, by name and by content.
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>

#include "formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

struct FormatInfo {
  std::string_view name;
  Format format;
  bool writable;
  bool (*available)();
  bool canonical;  ///< listed; the others are further spellings
};

bool always() { return true; }

constexpr std::array kFormats = {
    FormatInfo{"3mf", Format::ThreeMf, false, always, true},
    FormatInfo{"collada", Format::Collada, false, always, false},
    FormatInfo{"dae", Format::Collada, false, always, true},
    FormatInfo{"fbx", Format::Fbx, false, has_assimp, true},
    FormatInfo{"glb", Format::Glb, true, always, true},
    FormatInfo{"gltf", Format::Gltf, false, always, true},
    FormatInfo{"iges", Format::Iges, false, has_cad, true},
    FormatInfo{"igs", Format::Iges, false, has_cad, false},
    FormatInfo{"obj", Format::Obj, true, always, true},
    FormatInfo{"off", Format::Off, true, always, true},
    FormatInfo{"ply", Format::Ply, true, always, true},
    FormatInfo{"ply-ascii", Format::PlyAscii, true, always, true},
    FormatInfo{"step", Format::Step, false, has_cad, true},
    FormatInfo{"stl", Format::Stl, true, always, true},
    FormatInfo{"stl-ascii", Format::StlAscii, true, always, true},
    FormatInfo{"stp", Format::Step, false, has_cad, false},
    FormatInfo{"vrml", Format::Vrml, false, always, false},
    FormatInfo{"wrl", Format::Vrml, false, always, true},
    FormatInfo{"x3d", Format::X3d, false, always, true},
};

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

template <typename Accept>
std::vector<std::string> names_of(const Accept& accept) {
  std::vector<std::string> names;
  for (const FormatInfo& info : kFormats)
    if (info.canonical && accept(info)) names.emplace_back(info.name);
  return names;
}

ReadResult read_as(const Source& source, Format format) {
  switch (format) {
    case Format::Stl:
    case Format::StlAscii:
      return read_stl(source);
    case Format::Obj:
      return read_obj(source);
    case Format::Ply:
    case Format::PlyAscii:
      return read_ply(source);
    case Format::Off:
      return read_off(source);
    case Format::Vrml:
    case Format::X3d:
      return read_scene(source, format);
    case Format::ThreeMf:
      return read_three_mf(source);
    case Format::Collada:
      return read_collada(source);
    case Format::Glb:
    case Format::Gltf:
      return read_gltf(source, format);
    case Format::Fbx:
      return read_fbx(source);
    case Format::Step:
    case Format::Iges:
      return read_cad(source, format);
  }
  throw Error(ErrorCode::InvalidArgument, "unknown format");
}

/// A mesh without unused vertices and −0, and where its vertices are in the caller's mesh.
struct CleanMesh {
  geom::Mesh mesh;
  std::vector<std::uint32_t> original;
};

/// @throws Error{InvalidArgument} when the mesh is not valid.
CleanMesh cleaned(const geom::Mesh& mesh) {
  if (mesh.triangles.empty())
    throw Error(ErrorCode::InvalidArgument, "the mesh to be written has no triangles");
  constexpr std::uint32_t kUnused = 0xFFFFFFFF;
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  for (const geom::Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (corner >= mesh.vertices.size())
        throw Error(ErrorCode::InvalidArgument,
                    "a triangle of the mesh to be written refers to vertex " +
                        std::to_string(corner) + " of " + std::to_string(mesh.vertices.size()));
      number[corner] = 0;
    }
  }
  CleanMesh clean;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == kUnused) continue;
    if (!mesh.vertices[i].allFinite())
      throw Error(ErrorCode::InvalidArgument,
                  "vertex " + std::to_string(i) + " of the mesh to be written is not finite");
    number[i] = static_cast<std::uint32_t>(clean.original.size());
    clean.mesh.vertices.emplace_back(mesh.vertices[i].array() + 0.0);  // −0 + 0 = +0
    clean.original.push_back(static_cast<std::uint32_t>(i));
  }
  clean.mesh.triangles.reserve(mesh.triangles.size());
  for (const geom::Triangle& t : mesh.triangles)
    clean.mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return clean;
}

using Writer = std::vector<char> (*)(const geom::Mesh&, const WriteOptions&);

Writer writer_of(Format format) {
  switch (format) {
    case Format::Stl:
      return write_stl_binary;
    case Format::StlAscii:
      return write_stl_ascii;
    case Format::Obj:
      return write_obj;
    case Format::Ply:
      return write_ply_binary;
    case Format::PlyAscii:
      return write_ply_ascii;
    case Format::Off:
      return write_off;
    case Format::Glb:
      return write_glb;
    default:
      return nullptr;
  }
}

}  // namespace

std::optional<Format> format_from_name(std::string_view text) {
  if (text.starts_with('.')) text.remove_prefix(1);
  for (const FormatInfo& info : kFormats)
    if (same_word(text, info.name)) return info.format;
  return std::nullopt;
}

std::vector<std::string> readable_formats() {
  return names_of([](const FormatInfo& info) { return info.available(); });
}

std::vector<std::string> writable_formats() {
  return names_of([](const FormatInfo& info) { return info.writable; });
}

bool holds_double(Format format) {
  switch (format) {
    case Format::StlAscii:
    case Format::Obj:
    case Format::Ply:
    case Format::PlyAscii:
    case Format::Off:
    case Format::Vrml:
      return true;
    default:
      return false;
  }
}

bool is_cad(Format format) { return format == Format::Step || format == Format::Iges; }

ReadResult parse_mesh(std::span<const char> bytes, Format format, const std::string& name,
                      const std::filesystem::path& base_directory) {
  const Source source{{bytes.data(), bytes.size()}, name, base_directory, true};
  if (bytes.empty()) fail(source, "the file is empty; get it again");
  if (source.bytes.starts_with("\x1F\x8B"))
    fail(source, "the file is compressed with gzip; decompress it first (gunzip)");
  return read_as(source, format);
}

ReadResult read_mesh(const std::filesystem::path& path, std::optional<Format> format,
                     std::vector<char>* bytes_out) {
  const std::string name = path == "-" ? "standard input" : path.string();
  if (!format) format = format_from_name(path == "-" ? "" : path.extension().string());
  if (!format)
    throw Error(ErrorCode::InvalidInput,
                name + ": the format is not known from the name; state one of " +
                    joined(readable_formats()));
  std::vector<char> bytes = read_file(path);
  std::filesystem::path directory;
  if (path != "-") directory = path.has_parent_path() ? path.parent_path() : ".";
  ReadResult result = parse_mesh(bytes, *format, name, directory);
  if (bytes_out != nullptr) *bytes_out = std::move(bytes);
  return result;
}

std::vector<char> serialise_mesh(const geom::Mesh& mesh, Format format,
                                 const WriteOptions& options) {
  const Writer write = writer_of(format);
  if (write == nullptr)
    throw Error(ErrorCode::InvalidArgument, "meshes cannot be written in this format; use one of " +
                                                joined(writable_formats()));
  const CleanMesh clean = cleaned(mesh);
  if (format == Format::Stl) require_float(clean.mesh, clean.original, "binary STL");
  if (format == Format::Glb) require_float(clean.mesh, clean.original, "GLB");
  if (format == Format::Ply && !options.double_precision)
    require_float(clean.mesh, clean.original, "PLY in single precision");
  return write(clean.mesh, options);
}

}  // namespace kaboum::io
