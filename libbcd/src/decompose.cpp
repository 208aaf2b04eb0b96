// Convex bodies round a solid. Source: [gaschler2016] §4.4. The claim and its proof:
// docs/algorithms/convex-decomposition.md.

#include <kaboum/base/error.h>
#include <kaboum/bcd/decompose.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/holes.h>

#include <algorithm>
#include <utility>

#include "decomposer.h"
#include "options.h"
#include "pre_step.h"

namespace kaboum::bcd {
namespace {

/// The distance that counts is the one to the mesh that was not simplified.
void measure_anew(DecomposeResult& result, const Mesh& closed) {
  const SolidField solid(closed, kMeasuringGrid, 0);
  std::vector<Mesh> hulls;
  for (const geom::ConvexBody& body : result.bodies) hulls.push_back(body.hull);
  ReachOptions options;
  options.absolute_gap = kMeasuredGap * solid.diagonal();
  result.reach_lower = result.reach_upper = 0;
  for (const Reach& r : measure(hulls, solid, options)) {
    result.reach_lower = std::max(result.reach_lower, r.lower);
    result.reach_upper = std::max(result.reach_upper, r.upper);
  }
}

/// Work that is left, but not less than a share of all. [ns]
class Allowance {
 public:
  explicit Allowance(double seconds) {
    constexpr double kMost = 1e18;
    all_ = left_ = static_cast<std::uint64_t>(std::min(kMost, 1e9 * seconds));
  }
  [[nodiscard]] double left() const {
    return static_cast<double>(std::max(left_, all_ / kLeastWorkShare));
  }
  [[nodiscard]] bool plenty() const { return left_ > all_ / 2; }
  void spend(std::uint64_t work) { left_ -= std::min(left_, work); }

 private:
  std::uint64_t all_, left_;
};

/// Where epsilon asks for more than the limits allow: the nearest that keep to these, as if no
/// epsilon had been given.
DecomposeResult search(const Mesh& closed, const DecomposeOptions& options, Allowance& allowance) {
  Decomposer first(closed, options, allowance.left());
  DecomposeResult result = first.run();
  allowance.spend(first.work_done());
  if (!options.epsilon || result.stop != Stop::TooManyBodies) return result;
  DecomposeOptions limited = options;
  limited.epsilon.reset();
  Decomposer second(closed, limited, allowance.left());
  result = second.run();
  allowance.spend(second.work_done());
  if (result.reach_upper > *options.epsilon) result.stop = Stop::TooManyBodies;
  return result;
}

/// Few faces leave few cuts, and much hangs on the first: quick searches, with the planes of
/// symmetry and without them, sometimes find fewer bodies than the thorough one.
DecomposeResult with_quick_searches(const Mesh& closed, const DecomposeOptions& options,
                                    Allowance& allowance) {
  DecomposeResult best = search(closed, options, allowance);
  if (!options.epsilon || options.max_total_vertices || options.method != Method::Planes ||
      options.effort == Effort::Fast || closed.triangles.size() > kQuickTriangles ||
      (best.stop == Stop::Done && best.bodies.size() <= 2))
    return best;                      // one body has been tried
  DecomposeOptions silent = options;  // the progress has been told
  silent.progress = nullptr;
  for (const bool mirrors : {false, true}) {
    if (!allowance.plenty()) break;
    Tuning quick = tuning(Effort::Fast);
    quick.search.mirrors = mirrors;
    Decomposer decomposer(closed, silent, allowance.left(), quick);
    DecomposeResult other = decomposer.run();
    allowance.spend(decomposer.work_done());
    if (other.stop == Stop::Done &&
        (best.stop != Stop::Done || other.bodies.size() < best.bodies.size()))
      best = std::move(other);
  }
  return best;
}

DecomposeResult decompose_closed(const Mesh& closed, const DecomposeOptions& options) {
  Allowance allowance(work_allowed(options, closed.triangles.size()));
  if (const std::optional<Simpler> simpler = pre_step(closed, options)) {
    DecomposeOptions rest = options;
    if (rest.epsilon) *rest.epsilon -= simpler->distance;
    DecomposeResult result = search(simpler->mesh, rest, allowance);
    measure_anew(result, closed);
    result.statistics.pre_step_triangles = simpler->mesh.triangles.size();
    // What a limit does not allow within the rest of epsilon, it may allow within all of it.
    if (!options.epsilon || (result.stop == Stop::Done && result.reach_upper <= *options.epsilon))
      return result;
  }
  return with_quick_searches(closed, options, allowance);
}

}  // namespace

DecomposeResult decompose(const geom::Prepared& input, const DecomposeOptions& options) {
  require_sound(options);
  if (too_coarse(input.mesh, options)) {
    DecomposeResult coarse;
    coarse.stop = Stop::TooCoarse;
    return coarse;
  }
  if (input.closed && input.filled_triangles == 0 &&
      !geom::HullBuilder().build(input.mesh.vertices))
    throw Error(ErrorCode::InvalidInput,
                "the mesh is closed and lies in one plane, so it bounds no solid");
  const Mesh closed = input.closed ? input.mesh : geom::fill_holes(input.mesh).mesh;
  DecomposeResult result = decompose_closed(closed, options);
  result.statistics.filled_triangles =
      input.filled_triangles + closed.triangles.size() - input.mesh.triangles.size();
  return result;
}

}  // namespace kaboum::bcd
