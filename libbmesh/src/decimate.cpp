// Bounding mesh decimation: which runs an input takes. Source: [gaschler2016] §4.3, Algorithms 1
// and
// 2. The certificate and the error bound: docs/algorithms/bounding-mesh.md.

#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/convex_set.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "decimate_twice.h"
#include "decimation_run.h"

namespace kaboum::bmesh {
namespace {

/// Default of max_work: what a mesh of so many triangles takes with Effort::Normal on one core of a
/// machine of 2020, and for each triangle more. [s]
constexpr double kBaseWork = 12, kManyTriangles = 10000, kWorkPerTriangle = 2e-3;

/// Whether a cost looks at the angles between faces.
bool has_sharp_angle(Cost cost) {
  return cost == Cost::Planes || cost == Cost::PlanesAdapted || cost == Cost::PlanesDiagonal;
}

void check_options(const geom::SolidMesh& input, const DecimateOptions& options) {
  if (options.epsilon && !(*options.epsilon > 0 && std::isfinite(*options.epsilon)))
    throw Error(ErrorCode::InvalidArgument, "the error bound must be a positive length");
  if (options.max_work && !(*options.max_work > 0))
    throw Error(ErrorCode::InvalidArgument, "max_work must be positive");
  if (options.keep_convex && !geom::is_convex(input.mesh()))
    throw Error(ErrorCode::InvalidInput, "the input is not convex, so convexity cannot be kept");
  if (options.as_printed && options.cost != Cost::PlanesDiagonal)
    throw Error(ErrorCode::InvalidArgument, "as_printed is for Cost::PlanesDiagonal only");
  if (options.sharp_angle && !has_sharp_angle(options.cost))
    throw Error(ErrorCode::InvalidArgument, "sharp_angle is for the costs of planes only");
  if (possible_effort(input, options) != options.effort)
    throw Error(ErrorCode::InvalidArgument,
                "open meshes, and keep_convex, allow no more than Effort::Fast");
}

}  // namespace

double work_allowed(const geom::SolidMesh& input, const DecimateOptions& options) {
  if (options.max_work) return *options.max_work;
  if (options.effort == Effort::Best) return std::numeric_limits<double>::infinity();
  const auto triangles = static_cast<double>(input.mesh().triangles.size());
  return kBaseWork + kWorkPerTriangle * std::max(0.0, triangles - kManyTriangles);
}

Effort possible_effort(const geom::SolidMesh& input, const DecimateOptions& options) {
  const bool can_optimise =
      !options.keep_convex && (input.closed() || options.direction == Direction::Any);
  return can_optimise ? options.effort : Effort::Fast;
}

DecimateResult decimate(const geom::SolidMesh& input, const DecimateOptions& options) {
  if (!options.vertices && !options.epsilon)
    throw Error(ErrorCode::InvalidArgument,
                "decimation needs a number of vertices or an error bound");
  check_options(input, options);
  Work work(1e9 * work_allowed(input, options));
  DecimateResult result = is_small(input, options)
                              ? decimate_twice(input, options, work)
                              : DecimationRun(input, options, work).to(options.vertices);
  result.work = 1e-9 * static_cast<double>(work.done());
  return result;
}

std::vector<DecimateResult> decimate_series(const geom::SolidMesh& input,
                                            const DecimateOptions& options,
                                            std::span<const std::size_t> vertices) {
  if (vertices.empty() || options.vertices ||
      std::adjacent_find(vertices.begin(), vertices.end(), std::less_equal<>()) != vertices.end())
    throw Error(ErrorCode::InvalidArgument, "a series needs falling numbers of vertices");
  check_options(input, options);
  Work work(1e9 * work_allowed(input, options));
  DecimationRun run(input, options, work);
  std::vector<DecimateResult> levels;
  levels.reserve(vertices.size());  // what is nested in stays where it is
  for (const std::size_t target : vertices) {
    if (!levels.empty() && levels.back().stop != Stop::VertexTarget) {
      levels.push_back(levels.back());
      levels.back().steps.clear();  // none from there
      continue;
    }
    if (!levels.empty()) run.nest_in(levels.back().mesh);
    levels.push_back(run.to(target));
    levels.back().work = 1e-9 * static_cast<double>(work.done());
  }
  return levels;
}

}  // namespace kaboum::bmesh
