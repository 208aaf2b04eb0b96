// Convex bodies inside a solid: one is grown round the deepest point that is in
// none yet, until no point is deep. docs/algorithms/convex-decomposition.md,
// "From inside".

#include <kaboum/base/error.h>
#include <kaboum/bcd/inner.h>

#include <algorithm>
#include <cmath>

#include "depths.h"
#include "inscribe.h"
#include "options.h"

namespace kaboum::bcd {
namespace {

/// Triangles that others cross are cut to this share of epsilon or, without
/// one, of the diagonal.
constexpr double kSizeOfEpsilon = 0.08, kSizeOfDiagonal = 0.01;
/// Bodies, at most, where only epsilon limits them.
constexpr std::size_t kMostBodies = 20000;
/// Points that are found are as deep as any but for this share: seeds, and what
/// is reported.
constexpr double kSeedGap = 0.3, kReportedGap = 0.02;
/// Nothing is grown where it is less deep than this share of the diagonal.
constexpr double kLeastDepth = 1e-6;
/// About what a cube takes that is looked at, and growing a body per triangle.
/// [s]
constexpr double kCube = 60e-6, kTriangle = 2e-6;
/// A search looks at so many cubes, however little work is left.
constexpr double kFewestCubes = 1000;

struct InnerTuning {
  int rounds;         ///< fits of an ellipsoid per body
  std::size_t cubes;  ///< most cubes per search
};

InnerTuning tuning_inside(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {1, 200'000};
    case Effort::Normal:
      return {4, 1'000'000};
    case Effort::Best:
      break;
  }
  return {12, 10'000'000};
}

/// @throws Error{InvalidArgument}, Error{InvalidInput} as find_inner does
void require_inside(const geom::SolidMesh& input, const InnerOptions& options) {
  if (!options.epsilon && !options.max_bodies)
    throw Error(ErrorCode::InvalidArgument, "neither epsilon nor max_bodies is given");
  require_sound(options, options);
  require_doubtful(input.mesh(), options.doubtful);
  if (!input.closed())
    throw Error(ErrorCode::InvalidInput, "the mesh is open: bodies inside it mean nothing");
}

/// Grows bodies one after the other.
class InnerSearch {
 public:
  InnerSearch(const geom::Mesh& input, const InnerOptions& options)
      : input_(input),
        options_(options),
        diagonal_(geom::bounding_box(input).diagonal()),
        winding_(input),
        boundary_(boundary_of(
            input, winding_,
            options.epsilon ? kSizeOfEpsilon * *options.epsilon : kSizeOfDiagonal * diagonal_,
            options.doubtful)) {
    if (boundary_.outside.empty()) throw Error(ErrorCode::InvalidInput, "the mesh has no solid");
  }

  InnerCandidate run() {
    const InnerTuning effort = tuning_inside(options_.effort);
    Depths depths(input_, winding_, boundary_);
    Depths::Deepest deepest;
    const double allowed = work_allowed(options_, input_.triangles.size());
    const double per_body =
        kTriangle * effort.rounds * static_cast<double>(boundary_.mesh.triangles.size());
    double begin = 0, work = 0;
    for (;;) {
      const bool last = bodies_.size() >= most_;
      const auto cubes = static_cast<std::size_t>(
          std::clamp((allowed - work) / kCube, kFewestCubes, static_cast<double>(effort.cubes)));
      const std::size_t before = depths.looked();
      deepest = depths.search(bodies_, enough_, last ? kReportedGap : kSeedGap, !last, cubes);
      work += kCube * static_cast<double>(depths.looked() - before) + per_body;
      if (bodies_.empty()) begin = deepest.upper;
      if (deepest.upper <= enough_ || last || deepest.depth <= kLeastDepth * diagonal_) break;
      report(begin, deepest.upper);
      if (work >= allowed) {
        out_of_work_ = true;
        break;
      }
      std::optional<Inscribed> body =
          inscribe(boundary_.mesh, deepest.point, deepest.depth, options_.max_vertices,
                   effort.rounds, options_.safety);
      if (!body) break;
      bodies_.push_back(*std::move(body));
    }
    return result(deepest);
  }

 private:
  /// @param begin  depth of the whole solid; now no point left out is deeper
  /// than `upper`
  void report(double begin, double upper) const {
    if (!options_.progress) return;
    const double share = options_.max_bodies
                             ? static_cast<double>(bodies_.size()) / static_cast<double>(most_)
                             : std::log(begin / upper) / std::log(std::max(begin / enough_, 1.01));
    options_.progress({"filling", std::clamp(share, 0.0, 1.0)});
  }

  InnerCandidate result(const Depths::Deepest& deepest) {
    InnerCandidate out;
    out.out_of_work = out_of_work_;
    out.uncovered_depth_lower = deepest.lower;
    out.uncovered_depth_upper = deepest.upper;
    if (options_.epsilon && deepest.upper > *options_.epsilon)
      out.stop = bodies_.size() >= most_ ? Stop::TooManyBodies
                 : out_of_work_          ? Stop::OutOfWork
                                         : Stop::Stuck;
    for (Inscribed& body : bodies_) {
      out.vertices += body.hull.vertices.size();
      out.largest = std::max(out.largest, body.hull.vertices.size());
      out.bodies.push_back({"", std::move(body.hull)});
    }
    return out;
  }

  const geom::Mesh& input_;
  const InnerOptions& options_;
  double diagonal_;
  double enough_ = options_.epsilon.value_or(0);
  std::size_t most_ = options_.max_bodies.value_or(kMostBodies);
  geom::WindingNumber winding_;
  Boundary boundary_;
  std::vector<Inscribed> bodies_;
  bool out_of_work_ = false;
};

}  // namespace

InnerCandidate find_inner(const geom::SolidMesh& input, const InnerOptions& options) {
  require_inside(input, options);
  if (too_coarse(input.mesh(), options.epsilon)) {
    InnerCandidate coarse;
    coarse.stop = Stop::TooCoarse;
    return coarse;
  }
  return InnerSearch(input.mesh(), options).run();
}

}  // namespace kaboum::bcd
