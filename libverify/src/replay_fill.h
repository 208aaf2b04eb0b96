#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Which rim is none of a hole of the triangles, as docs/algorithms/preparation.md states them;
/// empty if all are: loops, each of them edges of one component where the triangles do not cancel,
/// against them, without a vertex twice, and no edge in more of them than it needs. Opposite
/// triangles are left out first.
///
/// That has to be checked, since solid and claims are those of the filled mesh: a closed surface
/// that is no fan on a hole could take from the solid what the input has in it.
///
/// @param triangles  the input's, with three different corners, as they were when holes were
/// filled;
/// @param rims  vertices of theirs.
std::string find_wrong_rim(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                           const std::vector<std::vector<std::uint32_t>>& rims);

}  // namespace kaboum::verify
