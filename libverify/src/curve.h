#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::verify {

/// Places along a curve through space (Morton's) that fills the points' box: neighbours on it are
/// near each other. Equal points have equal places. Coordinates are finite.
std::vector<std::uint64_t> places_on_curve(std::span<const geom::Vec3> points);

/// The numbers 0, 1, … by their places; equal places keep their order. Linear time.
std::vector<std::uint32_t> ordered_by(std::span<const std::uint64_t> places);

}  // namespace kaboum::verify
