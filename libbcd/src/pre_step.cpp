#include "pre_step.h"

#include <kaboum/bmesh/decimate.h>

namespace kaboum::bcd {
namespace {

/// Smaller meshes are decomposed about as fast as they are simplified.
constexpr std::size_t kLarge = 20000;

}  // namespace

std::optional<Simpler> pre_step(const geom::Mesh& closed, const DecomposeOptions& options) {
  if (options.pre_step == PreStep::Off ||
      (options.pre_step == PreStep::Auto && closed.triangles.size() <= kLarge))
    return std::nullopt;
  geom::Prepared input;
  input.mesh = closed;
  input.border.assign(closed.vertices.size(), 0);
  bmesh::DecimateOptions how;
  how.epsilon =
      options.epsilon ? 0.1 * *options.epsilon : 0.0005 * geom::bounding_box(closed).diagonal();
  if (options.progress)
    how.progress = [&](std::size_t) { options.progress({"simplifying the input", 0}); };
  Simpler out{bmesh::decimate(input, how).mesh, *how.epsilon};
  if (2 * out.mesh.triangles.size() > closed.triangles.size()) return std::nullopt;
  return out;
}

}  // namespace kaboum::bcd
