#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/topology.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Where three triangles or more meet and do not balance, a hole's rim runs along a wall: which
/// side of the wall has the hole depends on its orientation.
/// @param source  per triangle: the input's.
/// @param agreed  per input triangle: its patch was turned to agree with its neighbours.
/// @return an input triangle at such a wall, if there is any.
/// @throws Error{InvalidInput} where triangles there were turned to agree.
std::optional<std::uint32_t> judge_rims(std::span<const EdgeUse> edges,
                                        std::span<const std::uint32_t> source,
                                        std::span<const char> agreed);

/// The rims' vertices, each named by the first corner of the input that is there, as the input
/// orients it: 3 · triangle + corner.
/// @param source, turned  per triangle: the input's, and whether it was turned.
std::vector<std::vector<std::uint32_t>> name_rims(
    const std::vector<std::vector<std::uint32_t>>& rims, const Mesh& mesh,
    std::span<const std::uint32_t> source, std::span<const char> reversed);

}  // namespace kaboum::geom
