#pragma once

#include <kaboum/geom/topology.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Parts whose solid was guessed: the fill of their holes, or the edges that they agree at.
struct Guesses {
  std::vector<std::uint32_t> agreed;  ///< triangles that were turned to agree, with their patches
  std::vector<std::uint32_t> triangles;  ///< all of parts that have such ones, or that were open
  /// An input triangle of a part that was open and turned to agree, and has edges at which several
  /// sheets meet. Without those, a part can be turned to agree in one way only.
  std::optional<std::uint32_t> ambiguous;
};

/// @param part    per triangle: its part, joined through edges.
/// @param source  per triangle: the input's, but of those that fill holes, which come last.
/// @param agreed, opened  per input triangle: its patch was turned to agree; its part was open.
Guesses find_guesses(std::span<const EdgeUse> edges, std::span<const std::uint32_t> part,
                     std::span<const std::uint32_t> source, std::span<const char> agreed,
                     std::span<const char> opened);

/// Of each part at most 20,000 triangles, evenly; without parts, of all.
std::vector<std::uint32_t> some_of(std::span<const std::uint32_t> triangles,
                                   std::span<const std::uint32_t> part);

}  // namespace kaboum::geom
