#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/io/convex_io.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "source.h"

// The readers and writers behind parse_convex_set and serialise_convex_set. Internal to kaboum_io.
namespace kaboum::io {

/// glTF, binary or not: one body per place of a mesh in the scene.
geom::ConvexSet read_gltf_set(const Source& source, SetReadDetails& details);
/// One body per group; nullopt when there are fewer than two groups.
std::optional<geom::ConvexSet> read_obj_set(const Source& source, SetReadDetails& details);

/// Bodies hold only used vertices, all finite, no −0, and valid indices.
std::vector<char> write_glb_set(const geom::ConvexSet& set);
std::vector<char> write_obj_set(const geom::ConvexSet& set);

/// Margin and provenance.
nlohmann::ordered_json record_of(const geom::ConvexSet& set);
/// @throws Error{InvalidInput} when `record` is not what record_of writes.
void take_record(const nlohmann::ordered_json& record, const Source& source, geom::ConvexSet& set);

}  // namespace kaboum::io
