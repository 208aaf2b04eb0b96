// What options may be, and what follows from those that are not given.

#include "options.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kaboum::bcd {

namespace {

/// Largest spacing of float32 numbers that bodies are made with, as shares: rounding outwards takes
/// some spacings of each body, which epsilon has to leave room for.
constexpr double kSpacingOfEpsilon = 0.01, kSpacingWithEpsilon = 1e-4, kSpacingOfDiagonal = 1e-6;
/// Least max_aspect: what is thickened in all directions has less, whatever rounding does.
/// Robots' meshes ask for 1e-12 less than is asked of them, for what rounding of scales takes.
constexpr double kLeastAspect = 4, kRoundedScale = 1 - 1e-11;
/// Default of max_work, and what each triangle adds beyond so many. [s]
constexpr double kBaseWork = 20, kWorkPerTriangle = 1e-3, kManyTriangles = 1e4;

}  // namespace

double default_work(std::size_t triangles) {
  return kBaseWork +
         kWorkPerTriangle * std::max(0.0, static_cast<double>(triangles) - kManyTriangles);
}

double work_allowed(const SearchSettings& settings, std::size_t triangles) {
  return settings.max_work.value_or(settings.effort == Effort::Best
                                        ? std::numeric_limits<double>::infinity()
                                        : default_work(triangles));
}

void require_sound(const SearchSettings& settings, const SearchRun& run) {
  if (run.epsilon && !(*run.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument, "epsilon must be positive");
  for (const geom::BoundedRegion& one : run.regions)
    if (!run.epsilon || !(one.epsilon > 0))
      throw Error(ErrorCode::InvalidArgument,
                  "regions need an epsilon above 0 each, and one for all else");
  if (settings.max_bodies && !run.regions.empty())
    throw Error(ErrorCode::InvalidArgument, "regions do not go with a limit on the bodies");
  if (settings.max_bodies && *settings.max_bodies == 0)
    throw Error(ErrorCode::InvalidArgument, "max_bodies must be at least 1");
  if (settings.max_vertices < 8)
    throw Error(ErrorCode::InvalidArgument, "fewer than 8 vertices per body");
  if (settings.max_work && !(*settings.max_work > 0))
    throw Error(ErrorCode::InvalidArgument, "max_work must be positive");
}

void require_sound(const CoverOptions& options) {
  if (!options.epsilon && !options.max_bodies && !options.max_total_vertices)
    throw Error(ErrorCode::InvalidArgument,
                "neither epsilon nor max_bodies nor max_total_vertices is given");
  require_sound(options, options);
  if (options.improve_work && !(*options.improve_work >= 0))
    throw Error(ErrorCode::InvalidArgument, "improve_work must not be negative");
  if (options.max_total_vertices && !options.regions.empty())
    throw Error(ErrorCode::InvalidArgument, "regions do not go with a limit on all vertices");
  if (options.max_total_vertices && *options.max_total_vertices < 8)
    throw Error(ErrorCode::InvalidArgument, "max_total_vertices must be at least 8");
  if (!(options.min_thickness >= 0) || !std::isfinite(options.min_thickness))
    throw Error(ErrorCode::InvalidArgument, "the least thickness must be finite and not negative");
  if (options.max_aspect && !(*options.max_aspect >= kLeastAspect * kRoundedScale))
    throw Error(ErrorCode::InvalidArgument,
                "max_aspect must be at least 4, in proportions that scales leave as well");
  if (!(options.simplify_share() >= 0 && options.simplify_share() <= 1))
    throw Error(ErrorCode::InvalidArgument, "the share for simplification must be from 0 to 1");
  if (options.max_facets && *options.max_facets < 6)
    throw Error(ErrorCode::InvalidArgument, "fewer than 6 facets per body");
  if (options.max_facets &&
      (options.max_total_vertices || options.min_thickness > 0 || options.max_aspect))
    throw Error(ErrorCode::InvalidArgument,
                "a limit on facets does not go with one on all vertices together, a least "
                "thickness, or a largest aspect: what these change has other facets");
  if (options.max_total_vertices && (options.min_thickness > 0 || options.max_aspect))
    throw Error(ErrorCode::InvalidArgument,
                "a limit on all vertices together does not go with a least thickness, or a largest "
                "aspect: bodies are simplified after they are thickened");
}

void require_doubtful(const geom::Mesh& mesh, const std::vector<std::uint32_t>& doubtful) {
  for (const std::uint32_t t : doubtful)
    if (t >= mesh.triangles.size())
      throw Error(ErrorCode::InvalidArgument,
                  "doubtful triangle " + std::to_string(t) + " is none of the mesh's " +
                      std::to_string(mesh.triangles.size()) + "; name triangles of the mesh given");
}

bool too_coarse(const geom::Mesh& mesh, const std::optional<double>& epsilon) {
  double magnitude = 0;
  for (const geom::Vec3& p : mesh.vertices)
    magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  const double spacing = geom::float32_spacing(magnitude);
  const double diagonal = geom::bounding_box(mesh).diagonal();
  return spacing > (epsilon ? std::min(kSpacingWithEpsilon * diagonal, kSpacingOfEpsilon * *epsilon)
                            : kSpacingOfDiagonal * diagonal);
}

std::optional<double> finest_epsilon(const SearchRun& run) {
  std::optional<double> out = run.epsilon;
  for (const geom::BoundedRegion& one : run.regions)
    if (out) out = std::min(*out, one.epsilon);
  return out;
}

}  // namespace kaboum::bcd
