#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io {

/// File formats. `Stl` is told apart into ASCII and binary when reading; the other encodings only
/// matter when writing.
enum class Format {
  Stl,
  StlAscii,
  Obj,
  Ply,
  PlyAscii,
  Off,
  Glb,
  Gltf,
  Collada,
  Fbx,
  ThreeMf,
  X3d,
  Vrml,
  Step,
  Iges,
  Assimp  ///< what has no reader here and assimp reads: never by itself, only where it is stated
};

/// Format named by `text`: a format name ("stl", "ply-ascii") or a file name's extension (".stl").
/// @return nullopt when unknown.
std::optional<Format> format_from_name(std::string_view text);

/// Names accepted by format_from_name that can be read / written by this build, sorted.
std::vector<std::string> readable_formats();
std::vector<std::string> writable_formats();

/// Extensions of the files that Assimp is for, sorted: "3ds", "ac", ...
std::vector<std::string> imported_extensions();

/// What to do with a file that has such an extension; empty for others.
std::string route_to_assimp(const std::filesystem::path& path);

/// Format that a file is read in: what is stated, else what the extension of its name says. Assimp,
/// stated, is for files of which the extension says no other.
/// @throws Error{InvalidInput} where neither says one, with the remedy.
Format format_of_file(const std::filesystem::path& path, std::optional<Format> stated = {});

/// True when the format stores coordinates as text or as 64-bit floats, so that doubles survive.
bool holds_double(Format format);

/// True if files of the format hold exact faces, which the triangles that are read stand for
/// (ReadResult::deviation): STEP and IGES.
bool is_cad(Format format);

/// A mesh as read, and what the reader did on the way.
struct ReadResult {
  geom::Mesh mesh;  ///< vertices with equal coordinates merged (−0 = +0), in order of first use
  Format format;
  /// The coordinates came as float32 (binary STL, binary PLY with float x, y, z, assimp).
  /// Transforms of scene nodes are applied after that, in double.
  bool single_precision = false;
  std::size_t file_vertices = 0;   ///< as stored, before merging
  std::size_t file_triangles = 0;  ///< after splitting polygons, before anything is dropped
  std::size_t split_polygons = 0;  ///< faces with more than three corners that were triangulated
  /// Polygons whose corners are not in one plane, exactly: how they are split makes a difference.
  std::size_t bent_polygons = 0;
  /// No bent polygon's corners lie farther apart than this across a plane. [length]
  double largest_bend = 0;
  /// Bent polygons of four corners, each by the first of its two triangles, which follow each
  /// other: geom::PrepareOptions takes the diagonal that encloses, or is enclosed by, both ways.
  std::vector<std::uint32_t> bent_quads = {};
  std::size_t collapsed_triangles = 0;  ///< dropped: two or three equal corners after merging
  std::vector<std::string> notes;       ///< things a user should know; one sentence each
  /// Files read besides this one, each once: VRML's and X3D's Inline, glTF's buffers.
  std::vector<std::string> other_files = {};
  /// Unit of length of the vertices where the file states it (3MF, FBX, X3D) or its format has one
  /// (COLLADA, glTF: m): one of kLengthUnits, or a length ("0.005 m"). Empty: nothing says it.
  std::string unit = {};
  /// Proved deviation of CAD files: the exact faces, which are what is meant, are no farther from
  /// the triangles than this (docs/formats.md). 0: the triangles are meant. [length]
  double deviation = 0;
  std::size_t exact_faces = 0;  ///< of CAD files, one for each place of a face
};

/// Note on a mesh whose triangles stand for exact faces, wherever something is said
/// about the triangles alone; empty where they are what is meant.
std::string about_exact_faces(const ReadResult& read);

/// End of a verdict on triangles that assimp delivered (Format::Assimp), which may not be all that
/// the file holds; empty for others.
std::string about_import(const ReadResult& read);

/// Parses a file held in memory.
///
/// Coordinates become the doubles nearest to the numbers in the file. Polygons are triangulated
/// without adding vertices; the directed edges of the triangles sum up to those of the polygon, so
/// that closed polygon meshes stay closed. `name` appears in messages only, but for its extension,
/// by which assimp knows formats. Time and memory are bounded by the size of the input, whatever it
/// states about itself.
///
/// Scenes (VRML, X3D, COLLADA, 3MF, glTF and FBX): all meshes are merged, moved by their
/// nodes' transforms, which are applied in rounded double precision; a mirroring transform reverses
/// the faces. COLLADA: scaled to metres by its <unit>, its <up_axis> is ignored, as robot
/// descriptions expect. FBX, 3MF and X3D: not scaled. A note says so in each case. VRML and X3D:
/// LOD gives its finest level, Switch its choice. What is refused: docs/formats.md.
///
/// Assimp: in a child process with limits of memory and time; float32, axes and units as it has
/// them, no other file. It leaves out without a message what it does not know: a note says so.
/// Another has what it warned of. Skins, morph targets and what it calls an error are refused.
///
/// STEP and IGES: millimetres; triangles that stand for the exact faces within `deviation`, made by
/// OpenCASCADE, a module that is loaded in a child process with limits of memory and time.
///
/// @param base_directory  where files that this one refers to are found (VRML's Inline, glTF's
///   buffers), by relative paths; empty: nowhere.
/// @throws Error{InvalidInput} on malformed, truncated or empty data, on non-finite coordinates and
///   on indices out of range, naming the place (line or byte) and the remedy.
/// @throws Error{NotBuilt} when the format's reader is not part of this build.
/// @throws Error{LimitReached} on more than 2^32 − 2 vertices, and on scenes whose instances
///   multiply out of proportion to the file.
ReadResult parse_mesh(std::span<const char> bytes, Format format, const std::string& name,
                      const std::filesystem::path& base_directory = {});

/// Reads a file in the format of format_of_file. `-` is standard input and needs `format`, other
/// than Assimp. Also fills `bytes_out`, when not null, with the file's bytes (for hashing).
/// @throws as parse_mesh; Error{InvalidInput} when the file cannot be read or its format is
/// unknown.
ReadResult read_mesh(const std::filesystem::path& path, std::optional<Format> format = {},
                     std::vector<char>* bytes_out = nullptr);

struct WriteOptions {
  /// Store 64-bit floats where the format can (PLY); text formats always write enough digits to get
  /// the same double back. Formats that hold float32 only (binary STL, GLB) refuse coordinates that
  /// float32 cannot represent.
  bool double_precision = false;
  std::string comment;  ///< one line, written where the format has comments
};

/// The mesh as bytes of `format`. Vertices that no triangle uses are left out. Reading the bytes
/// back gives the same coordinates, bit for bit (−0 is written as 0).
/// @throws Error{OutputFailed} when the format cannot hold the coordinates exactly.
/// @throws Error{InvalidArgument} when the format cannot be written, and when the mesh is empty or
///   not valid.
std::vector<char> serialise_mesh(const geom::Mesh& mesh, Format format,
                                 const WriteOptions& options = {});

/// Writes bytes to `path` through a temporary file in the same directory and a rename, so that the
/// path holds either the old content or all of the new. Permissions and symbolic links stay. `-` is
/// standard output; it, /dev/stdout, pipes and devices are written directly.
/// @throws Error{OutputFailed}.
void write_file(const std::filesystem::path& path, std::span<const char> bytes);

/// All bytes of a file, or of standard input for `-`.
/// @throws Error{InvalidInput}; Error{LimitReached} for streams of more than 8 GiB.
std::vector<char> read_file(const std::filesystem::path& path);

/// SHA-256 of the bytes, lower-case hexadecimal.
std::string sha256(std::span<const char> bytes);

}  // namespace kaboum::io
