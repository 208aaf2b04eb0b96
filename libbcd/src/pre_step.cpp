// A coarser bounding mesh in place of a large input. Source: [gaschler2016] §4.4.2.

#include "pre_step.h"

#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/directed_distance.h>

#include <algorithm>
#include <vector>

#include "excess.h"
#include "tuning.h"

namespace kaboum::bcd {
namespace {

/// Smaller meshes are decomposed about as fast as they are simplified.
constexpr std::size_t kLarge = 20000;
/// What the bounding mesh may take of epsilon, or of the diagonal where there is none.
constexpr double kShare = 0.1, kShareOfDiagonal = 0.001;
/// Its distance is known to this share.
constexpr double kGap = 0.1;
/// Levels to choose from, and vertices below which a level is not halved.
constexpr std::size_t kMostLevels = 6, kFewVertices = 1000;

/// Bounding meshes with a share of the vertices, a half of that, …; the last one perhaps not quite.
std::vector<bmesh::DecimateResult> coarser(const geom::SolidMesh& closed, std::size_t vertices,
                                           const CoverOptions& options) {
  bmesh::DecimateOptions how;
  how.cost = bmesh::Cost::Distance;
  how.effort = bmesh::Effort::Fast;
  how.precision = bmesh::Precision::Double;
  if (options.progress)
    how.progress = [&](std::size_t) { options.progress({"simplifying the input", 0}); };
  std::vector<std::size_t> counts{vertices};
  while (counts.size() < kMostLevels && counts.back() >= kFewVertices)
    counts.push_back(counts.back() / 2);
  return bmesh::decimate_series(closed, how, counts);
}

}  // namespace

std::optional<Simpler> pre_step(const geom::SolidMesh& input, const CoverOptions& options) {
  const geom::Mesh& closed = input.mesh();
  if (options.pre_step == PreStep::Off || !options.regions.empty() ||
      (options.pre_step == PreStep::Auto && closed.triangles.size() <= kLarge))
    return std::nullopt;
  const double epsilon = options.epsilon ? kShare * *options.epsilon
                                         : kShareOfDiagonal * geom::bounding_box(closed).diagonal();
  // With half the vertices, decomposition takes as long, but has less of epsilon.
  const std::size_t most = closed.vertices.size() / (options.pre_step == PreStep::On ? 2 : 4);
  std::vector<bmesh::DecimateResult> levels;
  try {
    levels = coarser(input, most, options);
  } catch (const Error& error) {
    // What decimation refuses, decomposition need not.
    if (error.code() != ErrorCode::InvalidInput) throw;
    return std::nullopt;
  }
  const geom::DistanceQuery original(closed);
  geom::DistanceOptions gap;
  gap.relative_gap = kGap;
  for (; !levels.empty(); levels.pop_back()) {
    geom::Mesh& mesh = levels.back().mesh;
    if (mesh.vertices.size() > most) continue;  // not reached
    const double distance = geom::directed_distance(mesh, original, gap).max_upper;
    if (distance <= epsilon) return Simpler{std::move(mesh), distance};
  }
  return std::nullopt;
}

void measure_anew(CoverCandidate& result, const geom::Mesh& closed) {
  const SolidField solid(closed, kMeasuringGrid, 0);
  std::vector<geom::Mesh> hulls;
  for (const geom::ConvexBody& body : result.bodies) hulls.push_back(body.core);
  ExcessOptions options;
  options.absolute_gap = kMeasuredGap * solid.diagonal();
  options.worth_measuring = kWorthMeasuring;
  result.excess_lower = result.excess_upper = 0;
  for (const Excess& r : measure(hulls, solid, options)) {
    result.excess_lower = std::max(result.excess_lower, r.lower);
    result.excess_upper = std::max(result.excess_upper, r.upper);
  }
}

}  // namespace kaboum::bcd
