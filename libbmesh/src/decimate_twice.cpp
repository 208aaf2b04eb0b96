// Small meshes are decimated twice: the distance that a quick result has bounds a better one.
// docs/algorithms/bounding-mesh.md.

#include "decimate_twice.h"

#include <kaboum/geom/directed_distance.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "decimation_run.h"
#include "schedule.h"

namespace kaboum::bmesh {
namespace {

using geom::Mesh;

/// Distances that are compared are known to this share.
constexpr double kCompareGap = 0.02;

/// Certified upper bound of the Hausdorff distance.
double largest_distance(const Mesh& a, const Mesh& b) {
  geom::DistanceOptions gap;
  gap.relative_gap = kCompareGap;
  return std::max(geom::directed_distance(a, geom::DistanceQuery(b), gap).max_upper,
                  geom::directed_distance(b, geom::DistanceQuery(a), gap).max_upper);
}

/// Runs to the same number of vertices.
class Twice {
 public:
  Twice(const geom::SolidMesh& input, const DecimateOptions& options, Work& work)
      : input_(input), options_(options), work_(work) {}

  DecimateResult run() {
    DecimateOptions first = options_;
    if (quick_) first.effort = Effort::Fast;
    sketch_ = attempt(first, std::nullopt, true);
    if (work_.spent(kNoneBegins)) return fall_back_on_sketch();
    // Where a quick one leaves vertices without float32 places, more would be left within a bound.
    if (sketch_.result.stop == Stop::VertexTarget &&
        !(quick_ && sketch_.result.unrepresentable > 0)) {
      const RisingBound bound = bound_of_sketch();
      if (bound.from > 0 && bound.from < bound.to) {
        Attempt nearer = attempt(options_, bound, false);
        if (is_good(nearer)) return lowered(std::move(nearer), bound.from);
        if (work_.spent(kNoneMoves)) return fall_back_on_sketch();
      }
    }
    // Made again with moves. Where the number can hardly be reached, the first may still be nearer.
    Attempt again = attempt(options_, std::nullopt, false);
    if (!is_better(sketch_.result, again.result)) return std::move(again.result);
    sketch_.result.out_of_work = again.result.out_of_work;
    if (sketch_.result.stop != Stop::VertexTarget && again.result.stop == Stop::OutOfWork)
      sketch_.result.stop = Stop::OutOfWork;
    return std::move(sketch_.result);
  }

 private:
  struct Attempt {
    DecimateResult result;
    double reached = 0;  // without contractions that move the vertices around
    double bound = 0;    // as far as it has risen
  };

  Attempt attempt(const DecimateOptions& options, const std::optional<RisingBound>& bound,
                  bool sketch) {
    Attempt out;
    DecimationRun run(input_, options, work_, bound, sketch);
    out.result = run.to(options.vertices);
    out.reached = run.reached_alone();
    out.bound = run.bound();
    return out;
  }

  [[nodiscard]] bool is_good(const Attempt& a) const {
    return a.result.stop == Stop::VertexTarget &&
           a.result.unrepresentable <= sketch_.result.unrepresentable;
  }

  /// A result within a bound that began at `from`. Where it did not rise, the number is reached
  /// within less, too: then it begins lower, a few times.
  DecimateResult lowered(Attempt best, double from) {
    for (int i = 0; i < kBoundTimes && quick_ && best.bound <= from && !work_.spent(kNoneMoves);
         ++i) {
      const RisingBound bound{kBoundLowered * from, from, kBoundAlone};
      Attempt nearer = attempt(options_, bound, false);
      if (!is_good(nearer)) break;
      best = std::move(nearer);
      from = bound.from;
    }
    return std::move(best.result);
  }

  [[nodiscard]] RisingBound bound_of_sketch() const {
    const double distance = largest_distance(sketch_.result.mesh, input_.mesh());
    if (quick_) {
      const std::size_t most = kBoundFew * options_.vertices.value_or(0);
      const bool few = most < input_.mesh().vertices.size();
      return {(few ? kBoundFromFew : kBoundFrom) * distance, distance, kBoundAlone};
    }
    const bool best = options_.effort == Effort::Best;
    return {(best ? kBoundFromBest : kBoundFromInner) * sketch_.reached, distance,
            std::numeric_limits<double>::infinity()};
  }

  /// Fewer vertices, or as many that are nearer to the input.
  [[nodiscard]] bool is_better(const DecimateResult& a, const DecimateResult& b) const {
    const std::size_t n = a.mesh.vertices.size(), m = b.mesh.vertices.size();
    if (n != m) return n < m;
    return a.unrepresentable <= b.unrepresentable &&
           largest_distance(a.mesh, input_.mesh()) < largest_distance(b.mesh, input_.mesh());
  }

  DecimateResult fall_back_on_sketch() {
    sketch_.result.out_of_work = true;
    return std::move(sketch_.result);
  }

  const geom::SolidMesh& input_;
  const DecimateOptions& options_;
  Work& work_;
  /// Inwards the second time may take more than the work allowed: then the first one is the result.
  /// With Effort::Best results would be 3 % farther in the mean.
  bool quick_ = options_.direction != Direction::Inner && options_.effort != Effort::Best;
  Attempt sketch_;
};

}  // namespace

bool is_small(const geom::SolidMesh& input, const DecimateOptions& options) {
  return options.vertices && !options.epsilon && options.cost == Cost::Distance &&
         options.effort != Effort::Fast && input.mesh().vertices.size() <= kBoundVertices &&
         kBoundShare * *options.vertices <= input.mesh().vertices.size();
}

DecimateResult decimate_twice(const geom::SolidMesh& input, const DecimateOptions& options,
                              Work& work) {
  return Twice(input, options, work).run();
}

}  // namespace kaboum::bmesh
