#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/topology.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::geom {

/// The source of triangles that fill holes; a mesh has fewer triangles.
constexpr std::uint32_t kFilled = ~0U;

/// Triangles with the same three corners.
struct Coincident {
  std::vector<std::uint32_t> pairs;   ///< triangles in opposite pairs
  std::vector<std::uint32_t> copies;  ///< further triangles like one that stays
};

/// @param edges   as edge_uses returns them.
/// @param source  per triangle; those with kFilled are passed over.
Coincident find_coincident(const Mesh& mesh, std::span<const EdgeUse> edges,
                           std::span<const std::uint32_t> source);

/// Those of the copies whose edges balance among the copies alone, component by component.
std::vector<std::uint32_t> closed_copies(const Mesh& mesh, std::span<const std::uint32_t> copies);

/// A triangle that has cancelled with an opposite one.
struct Cancelled {
  std::uint32_t source;  ///< input triangle
  std::array<Vec3, 3> corners;
};

/// Inside the mesh's solid, opposite pairs are walls between touching bodies; elsewhere they are
/// sheets, which no solid protects.
/// @return those of `pairs` that are sheets.
std::vector<Cancelled> find_sheets(const Mesh& mesh, std::span<const Cancelled> pairs);

/// @throws Error{InvalidInput} that names the first of them.
[[noreturn]] void refuse_sheets(std::span<const Cancelled> sheets);

}  // namespace kaboum::geom
