// Meshes from files and to files: which format it is, by name and by content.
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

bool always() { return true; }

/// A reader as the table has it, of one that knows its format or is told.
template <auto kRead>
ReadResult read(const Source& source, Format format) {
  if constexpr (std::is_invocable_v<decltype(kRead), const Source&, Format>) {
    return kRead(source, format);
  } else {
    return kRead(source);
  }
}

using Writer = std::vector<char> (*)(const geom::Mesh&, const WriteOptions&);

/// A format of mesh files: all that is said of it here.
struct MeshFormat {
  Format format;
  std::string_view name;        ///< the extension of its files; what messages call it
  std::string_view other_name;  ///< another extension; empty: none
  ReadResult (*read)(const Source&, Format);
  Writer write = nullptr;        ///< null: it is only read
  bool doubles = false;          ///< its files can hold doubles exactly
  std::string_view floats = {};  ///< in messages, where it is written with floats alone
  bool (*available)() = always;
};

// Listed in this order.
constexpr std::array kFormats = {
    MeshFormat{Format::ThreeMf, "3mf", "", read<read_three_mf>},
    MeshFormat{Format::Collada, "dae", "collada", read<read_collada>},
    MeshFormat{.format = Format::Fbx,
               .name = "fbx",
               .other_name = "",
               .read = read<read_fbx>,
               .available = has_assimp},
    MeshFormat{.format = Format::Glb,
               .name = "glb",
               .other_name = "",
               .read = read<read_gltf>,
               .write = write_glb,
               .floats = "GLB"},
    MeshFormat{.format = Format::Gltf, .name = "gltf", .other_name = "", .read = read<read_gltf>},
    MeshFormat{.format = Format::Iges,
               .name = "iges",
               .other_name = "igs",
               .read = read<read_cad>,
               .available = has_cad},
    MeshFormat{Format::Obj, "obj", "", read<read_obj>, write_obj, true},
    MeshFormat{Format::Off, "off", "", read<read_off>, write_off, true},
    MeshFormat{Format::Ply, "ply", "", read<read_ply>, write_ply_binary, true},
    MeshFormat{Format::PlyAscii, "ply-ascii", "", read<read_ply>, write_ply_ascii, true},
    MeshFormat{.format = Format::Step,
               .name = "step",
               .other_name = "stp",
               .read = read<read_cad>,
               .available = has_cad},
    MeshFormat{.format = Format::Stl,
               .name = "stl",
               .other_name = "",
               .read = read<read_stl>,
               .write = write_stl_binary,
               .floats = "binary STL"},
    MeshFormat{Format::StlAscii, "stl-ascii", "", read<read_stl>, write_stl_ascii, true},
    MeshFormat{.format = Format::Vrml,
               .name = "wrl",
               .other_name = "vrml",
               .read = read<read_scene>,
               .doubles = true},
    MeshFormat{Format::X3d, "x3d", "", read<read_scene>},
    MeshFormat{.format = Format::Assimp,
               .name = "",  // of no file: it is asked for
               .other_name = "",
               .read = read<read_by_assimp>,
               .available = has_assimp},
};

/// Files that Format::Assimp is for: one file holds the geometry, in a format of which some is
/// triangles and polygons, and assimp 5.2 reads files of it. docs/formats.md says what is not here.
constexpr std::array<std::string_view, 36> kImported = {
    "3ds", "ac",  "ac3d",   "acc", "amf", "ase", "ask", "b3d", "blend", "cob", "dxf",  "enff",
    "hmp", "ifc", "ifczip", "iqm", "lwo", "lxo", "md2", "md3", "mdc",   "mdl", "mesh", "ms3d",
    "ndo", "nff", "ogex",   "prj", "q3o", "q3s", "raw", "scn", "sib",   "x",   "xgl",  "zgl"};

const MeshFormat& format_of(Format format) {
  for (const MeshFormat& known : kFormats)
    if (known.format == format) return known;
  throw Error(ErrorCode::InvalidArgument, "unknown format");
}

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

template <typename Accept>
std::vector<std::string> names_of(const Accept& accept) {
  std::vector<std::string> names;
  for (const MeshFormat& known : kFormats)
    if (!known.name.empty() && accept(known)) names.emplace_back(known.name);
  return names;
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

}  // namespace

std::optional<Format> format_from_name(std::string_view text) {
  if (text.starts_with('.')) text.remove_prefix(1);
  if (text.empty()) return std::nullopt;
  for (const MeshFormat& known : kFormats)
    if (same_word(text, known.name) || same_word(text, known.other_name)) return known.format;
  return std::nullopt;
}

std::vector<std::string> readable_formats() {
  return names_of([](const MeshFormat& known) { return known.available(); });
}

std::vector<std::string> writable_formats() {
  return names_of([](const MeshFormat& known) { return known.write != nullptr; });
}

std::vector<std::string> imported_extensions() { return {kImported.begin(), kImported.end()}; }

std::string_view imported_extension(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  for (const std::string_view known : kImported)
    if (!extension.empty() && same_word(std::string_view(extension).substr(1), known)) return known;
  return {};
}

std::string route_to_assimp(const std::filesystem::path& path) {
  if (imported_extension(path).empty()) return {};
  return "files of this format are read by assimp, on request only: «importer=assimp»; where "
         "that is no option, let mesh-prepare make a mesh of it first";
}

Format format_of_file(const std::filesystem::path& path, std::optional<Format> stated) {
  const bool file = path != "-", imports = stated == Format::Assimp;
  if (stated && !imports) return *stated;
  if (const auto known = format_from_name(file ? path.extension().string() : "")) return *known;
  if (imports && !imported_extension(path).empty()) return Format::Assimp;
  std::string why = route_to_assimp(path);
  if (imports && !file) why = "assimp knows formats by the names of files; name one";
  if (why.empty()) {
    why = "the format is not known from the name; state one of " + joined(readable_formats());
    if (imports) why += ", or name one as assimp knows it: " + joined(imported_extensions());
  }
  throw Error(ErrorCode::InvalidInput, (file ? path.string() : "standard input") + ": " + why);
}

bool holds_double(Format format) { return format_of(format).doubles; }

bool is_cad(Format format) { return format == Format::Step || format == Format::Iges; }

std::string about_import(const ReadResult& read) {
  if (read.format != Format::Assimp) return {};
  return ", of the triangles that assimp delivered: of what it may have left out of the file "
         "nothing is said";
}

ReadResult parse_mesh(std::span<const char> bytes, Format format, const std::string& name,
                      const std::filesystem::path& base_directory) {
  const Source source{{bytes.data(), bytes.size()}, name, base_directory, true};
  if (bytes.empty()) fail(source, "the file is empty; get it again");
  if (source.bytes.starts_with("\x1F\x8B"))
    fail(source, "the file is compressed with gzip; decompress it first (gunzip)");
  return format_of(format).read(source, format);
}

ReadResult read_mesh(const std::filesystem::path& path, std::optional<Format> format,
                     std::vector<char>* bytes_out) {
  const std::string name = path == "-" ? "standard input" : path.string();
  const Format known = format_of_file(path, format);
  std::vector<char> bytes = read_file(path);
  std::filesystem::path directory;
  if (path != "-") directory = path.has_parent_path() ? path.parent_path() : ".";
  ReadResult result = parse_mesh(bytes, known, name, directory);
  if (bytes_out != nullptr) *bytes_out = std::move(bytes);
  return result;
}

std::vector<char> serialise_mesh(const geom::Mesh& mesh, Format format,
                                 const WriteOptions& options) {
  const MeshFormat& as = format_of(format);
  if (as.write == nullptr)
    throw Error(ErrorCode::InvalidArgument, "meshes cannot be written in this format; use one of " +
                                                joined(writable_formats()));
  const CleanMesh clean = cleaned(mesh);
  if (!as.floats.empty()) require_float(clean.mesh, clean.original, std::string(as.floats));
  if (format == Format::Ply && !options.double_precision)
    require_float(clean.mesh, clean.original, "PLY in single precision");
  return as.write(clean.mesh, options);
}

}  // namespace kaboum::io
