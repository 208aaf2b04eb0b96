#pragma once

#include <kaboum/certify/mesh.h>

// Internal to kaboum_certify.
namespace kaboum::certify {

/// The options of the search; targets and callbacks apart.
bmesh::DecimateOptions options_of(const MeshRequest& request, const MeshPlan& plan);

}  // namespace kaboum::certify
