// An enclosing closed mesh of any triangles: tetrahedra carved from outside, steps towards the
// input.
#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/self_intersection.h>
#include <kaboum/geom/topology.h>
#include <kaboum/wrap/wrap.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "carving.h"
#include "fit.h"
#include "obstacle.h"
#include "simplify.h"
#include "surface.h"

namespace kaboum::wrap {
namespace {

void require_sound(const geom::Mesh& input, const WrapOptions& o) {
  for (const double length : {o.offset, o.seal})
    if (!(length > 0) || !std::isfinite(length))
      throw Error(ErrorCode::InvalidArgument, "the offset and the gap to seal must be above 0");
  if (!(o.clearance >= 0 && 3 * o.clearance <= o.offset))
    throw Error(ErrorCode::InvalidArgument,
                "the wrap's clearance must be between 0 and a third of its offset");
  if (input.triangles.empty())
    throw Error(ErrorCode::InvalidInput, "there are no triangles to wrap");
  geom::require_valid(input);
}

/// Spacing of the numbers that the wrap's coordinates may be, where it is widest.
double spacing_of(const geom::Box3& box, const WrapOptions& o) {
  const double most = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()) +
                      4 * (o.seal + o.offset);
  return o.float32 ? geom::float32_spacing(most) : std::ldexp(most, -52);
}

/// A wrap of this seal needs numbers so near to each other.
double spacing_for(const WrapOptions& o) { return o.seal / 8; }

/// @return what is wrong with coordinates whose numbers are too far apart, and what helps
std::string too_coarse(const geom::Box3& box, const WrapOptions& o) {
  const auto number = [](double x) {
    std::ostringstream s;
    s << std::setprecision(4) << x;
    return s.str();
  };
  const geom::Box3 moved{(box.min - box.max) / 2, (box.max - box.min) / 2};
  return std::string("numbers of ") + (o.float32 ? "32" : "64") + " bits are " +
         number(spacing_of(box, o)) +
         " apart at these coordinates, and a wrap that closes gaps of " + number(o.seal) +
         " needs them " + number(spacing_for(o)) + " apart at most; " +
         (spacing_of(moved, o) <= spacing_for(o) ? "move the mesh to the origin"
                                                 : "close wider gaps, or allow a larger epsilon") +
         (o.float32 ? ", or take numbers of 64 bits, in a format that holds them" : "");
}

void require_fine(const geom::Box3& box, const WrapOptions& o) {
  constexpr double kSmallest = 1e-40, kLargest = 1e40;
  const double diagonal = box.diagonal();
  if (diagonal > 0 && !(diagonal > kSmallest && diagonal < kLargest))
    throw Error(
        ErrorCode::InvalidInput,
        "the triangles are too small or too large for a wrap: their box has a diagonal of " +
            std::to_string(diagonal) + "; use another unit of length");
  if (!(spacing_of(box, o) <= spacing_for(o)))
    throw Error(ErrorCode::InvalidInput, too_coarse(box, o));
}

/// Refuses at once what carving would refuse after minutes, or take minutes for. Where no facet
/// rests, the triangles that carving ends with have circumradii of at most half the seal, so areas
/// of at most 1.3 times its square; above and below the input's largest triangle they cover its
/// area; and they have about half as many corners. Where facets can rest, points are along edges
/// only: a quarter of these, and mostly far less.
void require_few_points(const geom::Mesh& input, const CarvingOptions& o) {
  double largest = 0;
  for (const auto& [a, b, c] : input.triangles)
    largest = std::max(largest, (input.vertices[b] - input.vertices[a])
                                        .cross(input.vertices[c] - input.vertices[a])
                                        .norm() /
                                    2);
  // 0.77, with room for the few larger ones
  const double share = o.rest() < o.offset ? 0.5 : 0.125;
  if (share * (largest / o.radius / o.radius) > static_cast<double>(o.max_points))
    throw_too_fine(o.max_points);
}

/// What is claimed of a wrap by itself, decided for the coordinates that it has.
void decide_clean(const geom::Mesh& mesh) {
  const geom::TopologyReport topology = geom::analyse(mesh);
  ensure(topology.closed() && topology.manifold(), "a wrap is not a closed manifold");
  ensure(geom::self_intersections(mesh).none(), "a wrap meets itself");
}

}  // namespace

bool float32_is_fine(const geom::Box3& box, const WrapOptions& options) {
  WrapOptions o = options;
  o.float32 = true;
  return spacing_of(box, o) <= spacing_for(o);
}

Wrap wrap(const geom::Mesh& input, const WrapOptions& options) {
  require_sound(input, options);
  const auto say = [&](const char* stage) {
    if (options.progress) options.progress(stage);
  };
  const geom::Box3 box = geom::bounding_box(input);
  require_fine(box, options);
  const double clearance = options.clearance;
  const Obstacle obstacle(input, clearance);
  CarvingOptions carving;
  carving.radius = options.seal / 2;
  // Rounded coordinates have to be outside of the clearance as well.
  carving.offset = std::max(options.offset, 1.5 * clearance + 4 * spacing_of(box, options));
  carving.clearance = clearance;
  carving.float32 = options.float32;
  carving.max_points = options.max_points;
  require_few_points(input, carving);
  say("carving");
  Carving carved = carve(input, obstacle, carving);
  Wrap result;
  result.points = carved.points;
  result.first_triangles = carved.mesh.triangles.size();
  const geom::DistanceQuery first(carved.mesh);
  const Room room{first, options.seal, clearance, carving.offset};
  Surface surface(std::move(carved.mesh), obstacle, options.float32);
  Fit fit(surface, obstacle, room);
  say("edges");
  simplify(surface, obstacle, room, fit);
  say("vertices");
  fit.settle();
  fit.refine();
  fit.settle();
  say("edges");
  simplify(surface, obstacle, room, fit);
  result.mesh = surface.mesh();
  say("deciding");
  decide_clean(result.mesh);
  return result;
}

}  // namespace kaboum::wrap
