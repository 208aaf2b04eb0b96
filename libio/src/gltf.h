#pragma once

#include <functional>
#include <string>

#include "builder.h"
#include "gltf_file.h"

namespace kaboum::io {

/// What a scene consists of besides its triangles.
struct GltfFacts {
  std::size_t meshes = 0;  ///< places of meshes in the scene
  bool placed = false;     ///< some of them have a transform that is not the identity
  bool mirrored = false;   ///< or one that mirrors
  bool floats = true;      ///< every coordinate is a float32 number before transforms
};

/// Calls `builder_for(name)` for every place of a mesh in the default scene, in the order of its
/// nodes, and adds the mesh's triangles, moved by the transforms of nodes and instances, to the
/// builder that it returns. Files without scenes and nodes: all meshes as they are.
///
/// @param cores  points and lines are the cores of convex bodies: their points are added as well
///
/// docs/formats.md lists what is read, refused and ignored. Internal to kaboum_io.
///
/// @throws Error{InvalidInput} and Error{LimitReached}
GltfFacts read_gltf_scene(GltfFile& file,
                          const std::function<MeshBuilder&(const std::string&)>& builder_for,
                          bool cores = false);

/// Adds a note for what `facts` say about coordinates.
void note_gltf_facts(const GltfFacts& facts, GltfFile& file);

/// The key of a convex set's record in the root's `extras`.
inline constexpr const char* kGltfSetRecord = "kaboum_convex_set";

/// What our files name as the program that wrote them (glb.cpp, convex_glb.cpp).
inline constexpr const char* kGltfGenerator = "KABouM";

/// The unit of a file's lengths: what a set's record says; nothing, of a mesh of ours; else metres.
std::string gltf_unit(const GltfFile& file);

/// The record of a convex set in a file of ours, or nullptr.
const JsonItem::Json* gltf_set_record(const GltfFile& file);

}  // namespace kaboum::io
