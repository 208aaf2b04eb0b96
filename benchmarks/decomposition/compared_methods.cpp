// Bodies by clusters of triangles or by cuts between voxels, for comparison: the pieces are cut and
// joined in other ways, and finished like those of find_cover.

#include "compared_methods.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "clusters.h"
#include "finish.h"
#include "options.h"
#include "pre_step.h"
#include "search_state.h"
#include "voxel_cuts.h"

namespace kaboum::bcd {
namespace {

/// Weight of the added volume when bodies cut by voxels are merged: that of the distance.
constexpr double kVoxelVolumeWeight = 1;

/// Pieces to cut the solid into for so many bodies: the most of those that find_cover tries.
std::size_t pieces_for(std::size_t target, const Tuning& how) {
  return static_cast<std::size_t>(
      std::ceil(how.multiples.back() * (static_cast<double>(target) + kFewBodies) - kFewBodies));
}

/// The leaf with the largest distance of those that can be cut; -1: there is none.
int worst_leaf(const CutTree& tree, const std::set<int>& whole) {
  int worst = -1;
  for (const int leaf : tree.leaves()) {
    const CutTree::Node& node = tree.nodes()[leaf];
    if (node.stuck || whole.contains(leaf)) continue;
    if (worst < 0 || node.concavity.worst > tree.nodes()[worst].concavity.worst) worst = leaf;
  }
  return worst >= 0 && tree.nodes()[worst].concavity.worst > 0 ? worst : -1;
}

std::vector<Body> by_clusters(SearchState& state, std::size_t target) {
  CutTree& tree = state.tree();
  const std::size_t pieces = pieces_for(target, state.tuning());
  while (tree.leaf_count() < pieces && !state.spent(kCutting) && tree.cut_worst()) {
  }
  std::vector<Body> bodies =
      bodies_of_clusters(tree, state.solid(), cluster_triangles(state.solid(), target, kUnbounded));
  // Clusters that do not touch.
  if (bodies.size() > target) bodies = state.merged(std::move(bodies), target, kUnbounded);
  return bodies;
}

std::vector<Body> by_voxels(SearchState& state, std::size_t target) {
  const VoxelCuts voxels(state.solid(), state.tuning().grid);
  CutTree& tree = state.tree();
  const std::size_t pieces = pieces_for(target, state.tuning());
  std::set<int> whole;  // leaves too small to be cut
  while (tree.leaf_count() < pieces && !state.spent(kCutting)) {
    const int leaf = worst_leaf(tree, whole);
    if (leaf < 0) break;
    const CutTree::Node& node = tree.nodes()[leaf];
    const std::optional<Plane> plane =
        node.piece.polygons() == 0 ? std::nullopt : voxels.choose(node.piece.cell, node.hull);
    if (plane) {
      tree.cut(leaf, *plane);
    } else {
      whole.insert(leaf);
    }
  }
  return state.merged(state.leaf_bodies(), target, kUnbounded, kVoxelVolumeWeight);
}

/// Bodies round a closed mesh, simplified and measured.
CoverCandidate search(ComparedMethod method, const Mesh& closed, const CoverOptions& options,
                      double work) {
  SearchState state(closed, options, work, tuning(options.effort));
  Finisher finisher(state);
  state.begin_cutting();
  std::vector<Body> bodies = method == ComparedMethod::Clusters
                                 ? by_clusters(state, *options.max_bodies)
                                 : by_voxels(state, *options.max_bodies);
  const double free_cost = kFreeShare * options.simplify_share() * worst_of(bodies);
  CoverCandidate result;
  for (Finished& f : finisher.finish(bodies, free_cost)) {
    result.excess_lower = std::max(result.excess_lower, f.excess.lower);
    result.excess_upper = std::max(result.excess_upper, f.excess.upper);
    result.statistics.vertices += f.hull.vertices.size();
    result.statistics.largest = std::max(result.statistics.largest, f.hull.vertices.size());
    result.bodies.push_back({"", std::move(f.hull)});
  }
  result.stop = result.bodies.size() <= *options.max_bodies ? Stop::Done : Stop::TooManyBodies;
  result.statistics.leaves = state.tree().leaf_count();
  result.statistics.out_of_work = state.out_of_work();
  return result;
}

}  // namespace

CoverCandidate find_cover_by(ComparedMethod method, const geom::SolidMesh& input,
                             const CoverOptions& options) {
  require_sound(options);
  if (!options.max_bodies || options.epsilon || options.max_total_vertices ||
      options.min_thickness > 0 || options.max_aspect)
    throw Error(ErrorCode::InvalidArgument,
                "methods are compared by a number of bodies, with no other limits");
  CoverCandidate result;
  if (too_coarse(input.mesh(), options.epsilon)) {
    result.stop = Stop::TooCoarse;
    return result;
  }
  const geom::SolidMesh closed = geom::close_holes(input);
  constexpr double kMostWork = 1e18;
  const double work =
      std::min(kMostWork, 1e9 * work_allowed(options, closed.mesh().triangles.size()));
  if (const std::optional<Simpler> simpler = pre_step(closed, options)) {
    result = search(method, simpler->mesh, options, work);
    measure_anew(result, closed.mesh());
    result.statistics.pre_step_triangles = simpler->mesh.triangles.size();
  } else {
    result = search(method, closed.mesh(), options, work);
  }
  result.statistics.filled_triangles = closed.filled_triangles();
  return result;
}

}  // namespace kaboum::bcd
