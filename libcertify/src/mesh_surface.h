#pragma once

#include <kaboum/certify/mesh_certificate.h>
#include <kaboum/geom/prepare.h>

#include <optional>

// The surface claim about bounding meshes. Internal to kaboum_certify.
namespace kaboum::certify {

/// At most 20,000 faces are looked at. Ends early when some were found that do not bound the solid,
/// or where so many surfaces lie behind each other that it would take long: cut short.
SurfaceSamples sample_surface(const geom::Mesh& mesh);

/// What is allowed to be done for the surface claim of one result. [s]
/// @param allowed  for everything
/// @param done     by decimation
double work_for_surface(double allowed, double done, std::size_t results);

/// Decides the surface claim between original and result within `work`.
DecidedSurface decide_surface(const geom::Prepared& original, const geom::Mesh& result, bool outer,
                              double work);

/// How far the triangles of a claim that is refuted stick out, within `work`.
/// @pre no triangle is left open
void measure_sticking_out(const geom::Prepared& original, const geom::Mesh& result, bool outer,
                          double work, DecidedSurface& surface);

}  // namespace kaboum::certify
