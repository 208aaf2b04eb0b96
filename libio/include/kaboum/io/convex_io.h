#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io {

/// Forms that convex sets are stored in. docs/formats.md, "Convex sets".
enum class SetFormat {
  Glb,        ///< the container: glTF 2.0 binary, one mesh per body, the record in `extras`
  Obj,        ///< one `o` group per body
  Directory,  ///< a folder with one binary STL per body and the record in convex-set.json
};

/// Format that a path is written in: Glb and Obj by the extension, Directory when there is none (or
/// when the path is a folder). @return nullopt for other extensions.
std::optional<SetFormat> set_format_from_path(const std::filesystem::path& path);

/// Details of how a set was read.
struct SetReadDetails {
  std::vector<std::string> notes;  ///< things a user should know; one sentence each
  std::vector<char> bytes;         ///< of the file (of all files of a folder, in order)
  bool has_record = false;         ///< radii and provenance come from the file
  bool single_precision = false;   ///< coordinates were stored as float32
  std::string unit;                ///< as ReadResult::unit: what states it, or nothing
};

/// Whether what may be a mesh or a set, as GLB and OBJ files, is meant as a set: it has a record,
/// or several bodies that are all exactly convex.
bool is_meant_as_set(const geom::ConvexSet& set, const SetReadDetails& details);

/// The set that a folder or a file holds; nullopt where a file holds a mesh.
/// @throws Error as read_convex_set, of folders and of files that cannot be read
std::optional<geom::ConvexSet> find_convex_set(const std::string& path);

/// Parses a set from a file in memory: every mesh format, see read_convex_set.
/// @throws as parse_mesh.
geom::ConvexSet parse_convex_set(std::span<const char> bytes, Format format,
                                 const std::string& name, SetReadDetails* details = nullptr,
                                 const std::filesystem::path& base_directory = {});

/// Reads a set of bodies. They need not be convex: geom::find_not_convex tells.
///
/// - GLB and glTF: one body per place of a mesh, in the order of the scene's nodes. A file with a
///   record and with transforms of nodes is refused: the record would not hold.
/// - OBJ: one body per `o` or `g` statement that is followed by faces, if there are at least two.
/// - A folder: one body per STL file in it, in natural order of the names (2 before 10).
/// - Otherwise a plain mesh: one body per component connected through edges.
///
/// Equal vertices of a body are merged and triangles with repeated corners dropped; nothing else
/// changes. Coordinates are the doubles that the numbers in the file stand for.
///
/// @param path    a file, a folder, or `-` (standard input; needs `format`).
/// @param format  of the file; by its extension when not given.
/// @throws as read_mesh.
geom::ConvexSet read_convex_set(const std::filesystem::path& path,
                                std::optional<Format> format = {},
                                SetReadDetails* details = nullptr);

/// The set as the bytes of a GLB or OBJ file. Reading them back gives the same coordinates,
/// triangles, names and radii, and (GLB) the same provenance; vertices that no triangle uses are
/// left out. GLB may hold the empty set.
///
/// @throws Error{OutputFailed} when GLB would have to round a coordinate, and for a margin > 0 in a
///   format that knows none.
/// @throws Error{InvalidArgument} for Directory, for a negative or non-finite margin, for bodies
///   that are empty or not valid, and for an empty set in OBJ.
std::vector<char> serialise_convex_set(const geom::ConvexSet& set, SetFormat format);

/// The name of a body that has none, by its number: "body-0007". Files of a folder have these
/// names, with the folder's stem for "body", and the extension .stl.
std::string default_name(std::size_t index, std::string_view stem = "body");

/// Refuses, before anything is computed, a folder that write_convex_set would not replace.
/// @throws Error{OutputFailed}
void require_replaceable(const std::filesystem::path& folder);

/// Writes a set so that the path holds either what it held before or all of the new (folders: after
/// a crash between two renames, the old content may be left in a hidden folder beside it).
///
/// A folder is replaced only when it is empty or holds what this function wrote: convex-set.json
/// and the files STEM-NNNN.stl of the stem in it, nothing else.
///
/// @param stem  of a folder's files: engines tell meshes apart by it. No separators of paths.
/// @throws as serialise_convex_set; Error{OutputFailed} when the path cannot be written.
void write_convex_set(const std::filesystem::path& path, const geom::ConvexSet& set,
                      std::optional<SetFormat> format = {}, const std::string& stem = "body");

}  // namespace kaboum::io
