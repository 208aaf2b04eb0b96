#pragma once

#include <kaboum/bcd/cover.h>

#include <optional>

namespace kaboum::bcd {

/// A mesh with fewer triangles whose solid contains the closed mesh's, and how far its surface is
/// from the other one at most.
struct Simpler {
  geom::Mesh mesh;
  double distance;  ///< [length]
};

/// A bounding mesh within a tenth of epsilon (0.1 % of the diagonal, where only numbers are
/// limited), if the options ask for it and it is worth while. Source: [gaschler2016] §4.4.2.
std::optional<Simpler> pre_step(const geom::SolidMesh& closed, const CoverOptions& options);

/// The bracket of a result's distance, made anew from the mesh that was not simplified.
void measure_anew(CoverCandidate& result, const geom::Mesh& closed);

}  // namespace kaboum::bcd
