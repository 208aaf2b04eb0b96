#pragma once

#include <kaboum/base/option.h>
#include <kaboum/certify/enclosure.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/certify/preparation_options.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Options of a bounding mesh as a user states them; a request follows from them.
struct MeshOptions {
  /// Distances are measured and claims decided only where that is stated.
  MeshOptions() { request.measure = request.decide = false; }

  MeshRequest request;  ///< all but `format`, `comment` and `record_steps`
  PreparationOptions preparation;
};

/// The options of a bounding mesh.
const std::vector<Option<MeshOptions>>& mesh_options();

/// Why the options do not go together, with names as OptionDescription::text has them; empty where
/// they do.
/// @param stated  names of those that a user stated
std::string contradiction(const MeshOptions& options, const std::set<std::string>& stated);

/// Options of giving an input its solid for a bounding mesh.
/// @param bent_quads  of the input, as io::ReadResult has them; steps that are recorded start from
///   the file's own triangles
/// @param deviation   of its exact faces [length]; 0: the triangles are meant
MeshPreparation preparation_of(const MeshOptions& options,
                               const std::vector<std::uint32_t>& bent_quads, double deviation);

/// The request for a mesh that encloses that of a file.
EnclosureRequest enclosure_request_of(const MeshOptions& options);

/// The same of a robot's meshes, which engines read: STL or OBJ.
/// @param format  none: STL, and OBJ where float32 does not do.
/// @throws Error{InvalidArgument} for other formats, doubles in STL, and several numbers of
/// vertices.
EnclosureRequest link_request_of(MeshOptions options, const std::optional<io::Format>& format);

}  // namespace kaboum::certify
