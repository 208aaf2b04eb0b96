#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/points.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Evaluates faces inside their loops, edges in both of their forms, and vertices, at all knots and
/// between them. docs/algorithms/exact-inclusion.md, "Exact faces".
///
/// Nothing is shared with the reading that makes triangles but OpenCASCADE's file readers; a module
/// is loaded in a child process with limits of memory and time.
///
/// @param format   io::is_cad
/// @param density  parts of each interval between knots of an edge; a face has at least as many in
///   each direction, and three between knots. At least 1.
/// @param scale    the points are multiplied by it, as io::scale does.
/// @param faces    that the first reading has found: another number is refused.
/// @throws Error{NotBuilt} where the module is not there; Error{InvalidInput} where the file cannot
///   be read, or not all of it; Error{InvalidArgument} on a density of 0.
ExactPoints read_exact_points(std::span<const char> bytes, io::Format format,
                              const std::string& name, std::size_t density, double scale,
                              std::size_t faces);

}  // namespace kaboum::verify
