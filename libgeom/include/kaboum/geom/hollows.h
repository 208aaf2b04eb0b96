#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/winding.h>

#include <cstdint>
#include <optional>
#include <span>

namespace kaboum::geom {

/// A place that surfaces enclose and that is no part of the solid, although it need not be a
/// cavity.
struct Hollow {
  std::uint32_t triangle;  ///< beside it
  Vec3 at;
  bool at_wall;  ///< the triangle lies on an opposite one: the walls of two parts
};

/// Looks for a point with winding number 0, or less, that parts which share edges enclose.
///
/// Where parts share edges, their triangles can be put together into closed surfaces in more than
/// one way: an inward box with a wall in common with the outward one round it is as well a notch.
/// A point is enclosed if closed surfaces of any kind, made of a part's triangles, wind round it;
/// it is told by the winding number of one such surface, drawn at random (with a fixed seed).
/// docs/algorithms/preparation.md.
///
/// @param walls  welded and a closed chain: all triangles of a prepared mesh, and both of each pair
///   that has cancelled; or a mesh as it is.
/// @return the first found, beside the triangles in their order, those at walls first; every point
///   returned is enclosed and not in the solid. Of parts of more than 20,000 triangles so many are
///   looked at.
std::optional<Hollow> find_hollow(const Mesh& walls);

/// Looks beside triangles for a point with a winding number below 0: what a surface that crosses
/// itself, or parts joined against each other, enclose inside out.
///
/// @param mesh    a closed chain.
/// @param winding its winding number.
/// @param beside  triangles to look beside, on both sides.
/// @param part    per triangle: only those of the same part as the one looked beside count; each
///   part is a closed chain. Empty: all count.
/// @return the first found, in the order of `beside`.
std::optional<Hollow> find_inverted(const Mesh& mesh, const WindingNumber& winding,
                                    std::span<const std::uint32_t> beside,
                                    std::span<const std::uint32_t> part = {});

/// Looks beside triangles for a point with a winding number below 0; or of 0 or less, where a part
/// winds round it backwards although it winds round another point forwards. That is a pocket of a
/// surface that crosses itself, and not a cavity, whatever solid is round it.
///
/// @param part  per triangle; each part is a closed chain.
/// @return the first found, in the order of `beside`: those below 0 first.
std::optional<Hollow> find_pocket(const Mesh& mesh, const WindingNumber& winding,
                                  std::span<const std::uint32_t> beside,
                                  std::span<const std::uint32_t> part);

}  // namespace kaboum::geom
