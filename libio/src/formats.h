#pragma once

#include <kaboum/io/mesh_io.h>

#include "source.h"

// The readers and writers behind parse_mesh and serialise_mesh, one .cpp each. Internal to
// kaboum_io.
namespace kaboum::io {

ReadResult read_stl(Source source);
ReadResult read_obj(const Source& source);
ReadResult read_ply(Source source);
ReadResult read_off(const Source& source);
/// VRML 97 and X3D.
ReadResult read_scene(const Source& source, Format format);
ReadResult read_three_mf(Source source);
ReadResult read_collada(const Source& source);
/// glTF, binary or not.
ReadResult read_gltf(const Source& source, Format format);
/// @throws Error{NotBuilt} without assimp.
ReadResult read_fbx(const Source& source);
/// Format::Assimp: by the extension of the source's name. @throws as read_fbx.
ReadResult read_by_assimp(const Source& source);
bool has_assimp();
/// The extension of a name as assimp is told it, "3ds"; empty where Format::Assimp is not for it.
std::string_view imported_extension(const std::filesystem::path& path);
/// STEP and IGES. @throws Error{NotBuilt} where the module is not there.
ReadResult read_cad(const Source& source, Format format);
bool has_cad();

/// `mesh` holds only used vertices, all finite, no −0, and valid indices.
std::vector<char> write_stl_binary(const geom::Mesh& mesh, const WriteOptions& options);
std::vector<char> write_stl_ascii(const geom::Mesh& mesh, const WriteOptions& options);
std::vector<char> write_obj(const geom::Mesh& mesh, const WriteOptions& options);
std::vector<char> write_ply_binary(const geom::Mesh& mesh, const WriteOptions& options);
std::vector<char> write_ply_ascii(const geom::Mesh& mesh, const WriteOptions& options);
std::vector<char> write_off(const geom::Mesh& mesh, const WriteOptions& options);
std::vector<char> write_glb(const geom::Mesh& mesh, const WriteOptions& options);

}  // namespace kaboum::io
