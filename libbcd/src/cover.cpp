// Convex bodies round a solid. Source: [gaschler2016] §4.4. The claim and its proof:
// docs/algorithms/convex-decomposition.md.

#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <utility>

#include "body_bound.h"
#include "decomposer.h"
#include "options.h"
#include "pre_step.h"
#include "symmetry.h"

namespace kaboum::bcd {
namespace {

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
  [[nodiscard]] bool spent() const { return left_ == 0; }
  void spend(std::uint64_t work) { left_ -= std::min(left_, work); }

 private:
  std::uint64_t all_, left_;
};

CoverCandidate run(Decomposer& decomposer, Allowance& allowance) {
  CoverCandidate result = decomposer.run();
  allowance.spend(decomposer.work_done());
  return result;
}

/// The powers of two below `most`, the largest first: no larger number of bodies is farther than
/// these.
std::vector<std::size_t> rungs_below(std::size_t most) {
  std::vector<std::size_t> out;
  for (std::size_t power = 1; power < most; power *= 2) out.push_back(power);
  std::reverse(out.begin(), out.end());
  return out;
}

/// The nearest within the limits. Of bodies alone: among what is found for their number, and, by
/// the very same search, for every smaller rung that is not proved to be farther.
CoverCandidate nearest(const Mesh& closed, const CoverOptions& options, Allowance& allowance) {
  const double work = allowance.left();
  Decomposer first(closed, options, work);
  CoverCandidate best = run(first, allowance);
  if (options.max_total_vertices || best.stop != Stop::Done || best.statistics.out_of_work ||
      *options.max_bodies == 1)
    return best;
  const SolidField solid(closed, kBoundGrid, 0, false);
  const std::size_t too_few =
      too_few_bodies(closed, solid, best.excess_upper, *options.max_bodies - 1);
  allowance.spend(solid.work().done());
  CoverOptions fewer = options;
  fewer.progress = nullptr;  // it has been told
  for (const std::size_t rung : rungs_below(*options.max_bodies)) {
    if (rung <= too_few || allowance.spent()) break;
    fewer.max_bodies = rung;
    Decomposer smaller(first, fewer, work);
    CoverCandidate other = run(smaller, allowance);
    if (other.stop == Stop::Done && other.excess_upper < best.excess_upper) best = std::move(other);
  }
  return best;
}

/// Where epsilon asks for more than the limits allow: the nearest that keep to these, as if no
/// epsilon had been given.
CoverCandidate search(const Mesh& closed, const CoverOptions& options, Allowance& allowance) {
  if (!options.epsilon) return nearest(closed, options, allowance);
  Decomposer decomposer(closed, options, allowance.left());
  CoverCandidate result = run(decomposer, allowance);
  if (result.stop != Stop::TooManyBodies) return result;
  CoverOptions limited = options;
  limited.epsilon.reset();
  result = nearest(closed, limited, allowance);
  if (result.excess_upper > *options.epsilon) result.stop = Stop::TooManyBodies;
  return result;
}

/// Whether fewer bodies within epsilon are proved to be too few.
bool are_fewest(const Mesh& closed, const CoverOptions& options, const CoverCandidate& result) {
  if (result.stop != Stop::Done || result.bodies.size() > tuning(options.effort).counted)
    return false;
  const std::size_t fewer = result.bodies.size() - 1;
  if (fewer < 2) return true;  // one body has been tried
  const SolidField solid(closed, kBoundGrid, 0, false);
  return too_few_bodies(closed, solid, *options.epsilon, fewer) == fewer;
}

/// Few faces leave few cuts, and much hangs on the first: quick searches, with the planes of
/// symmetry, if there are any, and without them, sometimes find fewer bodies than the thorough one.
CoverCandidate with_quick_searches(const Mesh& closed, const CoverOptions& options,
                                   Allowance& allowance) {
  CoverCandidate best = search(closed, options, allowance);
  if (!options.epsilon || options.max_total_vertices || options.effort == Effort::Fast ||
      closed.triangles.size() > kQuickTriangles || are_fewest(closed, options, best))
    return best;
  CoverOptions silent = options;  // the progress has been told
  silent.progress = nullptr;
  for (const bool mirrors : {false, true}) {
    if (!allowance.plenty()) break;
    if (mirrors && mirror_planes(SolidField(closed, kMeasuringGrid, 0, false)).empty()) break;
    Decomposer decomposer(closed, silent, allowance.left(), quick_tuning(mirrors));
    CoverCandidate other = run(decomposer, allowance);
    if (other.stop == Stop::Done &&
        (best.stop != Stop::Done || other.bodies.size() < best.bodies.size())) {
      // The thorough search, with more work, might have found fewer.
      other.statistics.out_of_work |= best.statistics.out_of_work;
      best = std::move(other);
    }
  }
  return best;
}

CoverCandidate cover_closed(const geom::SolidMesh& input, const CoverOptions& options) {
  const Mesh& closed = input.mesh();
  Allowance allowance(work_allowed(options, closed.triangles.size()));
  if (const std::optional<Simpler> simpler = pre_step(input, options)) {
    CoverOptions rest = options;
    if (rest.epsilon) *rest.epsilon -= simpler->distance;
    CoverCandidate result = search(simpler->mesh, rest, allowance);
    measure_anew(result, closed);
    result.statistics.pre_step_triangles = simpler->mesh.triangles.size();
    // What a limit does not allow within the rest of epsilon, it may allow within all of it.
    if (!options.epsilon || (result.stop == Stop::Done && result.excess_upper <= *options.epsilon))
      return result;
  }
  return with_quick_searches(closed, options, allowance);
}

}  // namespace

CoverCandidate find_cover(const geom::SolidMesh& input, const CoverOptions& options) {
  require_sound(options);
  if (too_coarse(input.mesh(), finest_epsilon(options))) {
    CoverCandidate coarse;
    coarse.stop = Stop::TooCoarse;
    return coarse;
  }
  if (input.closed() && input.filled_triangles() == 0 &&
      !geom::HullBuilder().build(input.mesh().vertices))
    throw Error(ErrorCode::InvalidInput,
                "the mesh is closed and lies in one plane, so it bounds no solid");
  const geom::SolidMesh closed = geom::close_holes(input);
  CoverCandidate result = cover_closed(closed, options);
  if (!options.regions.empty()) result.excess_lower = 0;  // of weighted distances
  result.statistics.filled_triangles = closed.filled_triangles();
  return result;
}

}  // namespace kaboum::bcd
