#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/bcd/decompose.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/holes.h>
#include <kaboum/geom/width.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include "clusters.h"
#include "options.h"
#include "outward.h"
#include "pre_step.h"
#include "reach.h"
#include "search.h"
#include "simplify.h"
#include "thicken.h"
#include "voxel_cuts.h"

namespace kaboum::bcd {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// A body's nodes of the tree that may be parted, if it has as many.
constexpr std::size_t kPieces = 24;
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// Shares of the work allowed: after the first, no more pieces are cut; after the second, nothing
/// is improved; after the last, no body is taken apart or thinned out.
constexpr double kCutting = 0.4, kImproving = 0.7, kFinishing = 0.85;

struct Tuning {
  std::size_t grid;
  SearchOptions search;
  std::vector<double> multiples;   ///< of the wished bodies, that the input is cut into
  std::vector<double> thresholds;  ///< of epsilon, that leaves are cut down to
  std::vector<double> bulks;       ///< weights of the added volume when merging, tried in turn
  int refinements;                 ///< rounds of changing the worst body
  int rounds;                      ///< of refining what measuring finds
  bool reduce = false;             ///< look for fewer bodies within epsilon by their number
};

Tuning tuning(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {.grid = 60000,
              .search = {.offsets = 5, .reflex_planes = 6, .refinements = 1, .mirrors = false},
              .multiples = {1.5},
              .thresholds = {0.8},
              .bulks = {0.05},
              .refinements = 12,
              .rounds = 1};
    case Effort::Normal:
      return {200000, {}, {1, 1.25, 1.5, 2, 3}, {0.8}, {0.05, 0.15, 0.02}, 60, 2, true};
    case Effort::Best:
      break;
  }
  return {1000000,
          {.offsets = 11, .reflex_planes = 16, .refinements = 4, .look_ahead = 8},
          {1, 1.25, 1.5, 2, 3, 4.5, 6},
          {1, 0.85, 0.7, 0.5, 0.35},
          {0.05, 0.15, 0.02, 0.3, 0},
          200,
          4,
          true};
}

/// Nothing but what the other methods do; merging counts volume as they do.
Tuning tuning(Effort effort, Method method) {
  Tuning out = tuning(effort);
  if (method == Method::Planes) return out;
  out.multiples = {out.multiples.back()};
  out.thresholds = {out.thresholds.front()};
  out.bulks = {1};
  out.refinements = 0;
  out.rounds = 1;
  out.reduce = false;
  return out;
}

/// A body on its way to the result.
struct Finished {
  Body body;
  Mesh hull;
  Reach reach;
  bool thickened = false;
};

class Decomposer {
 public:
  Decomposer(const Mesh& closed, const DecomposeOptions& options, double work)
      : Decomposer(closed, options, work, tuning(options.effort, options.method)) {}

  /// @param work  allowed. [ns]
  Decomposer(const Mesh& closed, const DecomposeOptions& options, double work, Tuning how)
      : options_(options),
        tuning_(std::move(how)),
        solid_(closed, tuning_.grid, options.epsilon.value_or(0), false, work),
        tree_(solid_, search_options(), options.safety) {
    double magnitude = 0;
    for (const Vec3& p : closed.vertices) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
    point_error_ = 0x1p-40 * options.safety * magnitude;
  }

  /// Stop::TooManyBodies, and no bodies, where epsilon asks for more than the limits allow.
  DecomposeResult run() {
    std::vector<Finished> bodies;
    if (options_.epsilon) {
      bodies = within(*options_.epsilon, hopeless());
      if (tuning_.reduce) {
        reduce(bodies, *options_.epsilon);
        dissolve(bodies, *options_.epsilon);
      }
      if (options_.max_total_vertices) thin_out(bodies, *options_.epsilon);
      result_.stop = Stop::Done;
      for (const Finished& f : bodies)
        if (f.reach.upper > *options_.epsilon)
          result_.stop = out_of_work_ ? Stop::OutOfWork : Stop::Stuck;
      if (!fits(bodies)) {
        result_.stop = Stop::TooManyBodies;
        return std::move(result_);
      }
    } else {
      bodies = options_.max_total_vertices ? nearest_that_fit() : at_most(*options_.max_bodies);
      result_.stop = fits(bodies) ? Stop::Done : Stop::TooManyBodies;
    }
    result_.statistics.out_of_work = out_of_work_;
    result_.statistics.leaves = tree_.leaf_count();
    for (Finished& f : bodies) {
      result_.reach_lower = std::max(result_.reach_lower, f.reach.lower);
      result_.reach_upper = std::max(result_.reach_upper, f.reach.upper);
      result_.statistics.vertices += f.hull.vertices.size();
      result_.statistics.largest = std::max(result_.statistics.largest, f.hull.vertices.size());
      result_.statistics.thickened += f.thickened ? 1 : 0;
      result_.bodies.push_back({"", std::move(f.hull)});
    }
    return std::move(result_);
  }

  [[nodiscard]] std::uint64_t work_done() const { return solid_.work().done(); }

 private:
  [[nodiscard]] SearchOptions search_options() const {
    SearchOptions out = tuning_.search;
    if (!options_.epsilon && options_.method == Method::Planes) out.halving_bonus = 0.1;
    if (options_.method == Method::Voxels)
      out.choose = [voxels = std::make_shared<VoxelCuts>(solid_, tuning_.grid)](
                       const Cell& cell, const std::vector<Vec3>& hull) {
        return voxels->choose(cell, hull);
      };
    return out;
  }

  /// Whether this share of the work allowed has been done; the result then says that it was.
  bool spent(double share) {
    const bool out = solid_.work().spent(share);
    out_of_work_ = out_of_work_ || out;
    return out;
  }

  void report(const char* stage, double fraction) {
    if (options_.progress) options_.progress({stage, fraction});
  }

  /// What only a search for cuts needs.
  void begin_search() {
    if (std::exchange(begun_, true)) return;
    report("looking for pits", 0);
    solid_.find_probes();
    tree_.reappraise();
  }

  /// The hull of everything, if that is within epsilon: no search finds fewer bodies.
  std::vector<Finished> hull_within(double epsilon) {
    std::vector<Body> whole{body_of(tree_, 0)};
    if (options_.method != Method::Planes || whole[0].appraisal.worst > epsilon) return {};
    std::vector<Finished> out = finish(whole, options_.simplify * 0.93 * epsilon, epsilon);
    if (!good(out, epsilon)) out.clear();
    return out;
  }

  /// One body per leaf, as they were when there were this many.
  [[nodiscard]] std::vector<Body> leaf_bodies(
      std::size_t count = std::numeric_limits<std::size_t>::max()) const {
    std::vector<Body> out;
    for (const int leaf : tree_.leaves(count)) out.push_back(body_of(tree_, leaf));
    return out;
  }

  std::vector<Body> merged(std::vector<Body> bodies, std::size_t target, double epsilon,
                           double bulk = 0.05) {
    return merge(std::move(bodies), solid_, target, epsilon, bulk, memo_);
  }

  [[nodiscard]] static double reach_of(const std::vector<Finished>& bodies) {
    double reach = 0;
    for (const Finished& f : bodies) reach = std::max(reach, f.reach.upper);
    return reach;
  }
  /// Whether nothing more is wished.
  [[nodiscard]] static bool good(const std::vector<Finished>& bodies, double epsilon) {
    return !bodies.empty() && epsilon < kUnbounded && reach_of(bodies) <= epsilon;
  }

  [[nodiscard]] static double worst_of(const std::vector<Body>& bodies) {
    double worst = 0;
    for (const Body& b : bodies) worst = std::max(worst, b.appraisal.worst);
    return worst;
  }

  /// At most this many bodies, the first attempts of all that come nearest to the solid; none when
  /// that is not below `least`.
  std::vector<Body> best_merge(const std::vector<std::vector<Body>>& snapshots, std::size_t target,
                               double least) {
    std::vector<Body> best;
    if (snapshots[0].size() <= target && worst_of(snapshots[0]) < least) {
      best = snapshots[0];
      least = worst_of(best);
    }
    for (const auto& snapshot : snapshots) {
      for (const double bulk : tuning_.bulks) {
        if (!best.empty() && spent(kImproving)) return best;
        std::vector<Body> bodies = merged(snapshot, target, least, bulk);
        if (bodies.size() > target) continue;
        const double worst = worst_of(bodies);
        if (worst >= least) continue;
        least = worst;
        best = std::move(bodies);
      }
    }
    return best;
  }

  /// Gives a piece of a body to another one if both are then better than the body was.
  bool hand_over(std::vector<Body>& bodies, std::size_t from) const {
    const Body& giver = bodies[from];
    if (giver.leaves.size() < 2) return false;
    const std::vector<int> pieces = nodes_of(giver, kPieces);
    struct Deal {
      std::size_t leaf, to;
      double worst = std::numeric_limits<double>::infinity();
    };
    std::vector<Deal> deals;
    std::vector<Body> rests(pieces.size()), parts(pieces.size());
    parallel_loop(std::size_t{0}, pieces.size(), [&](std::size_t i) {
      std::vector<int> rest = pieces;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      rests[i] = union_of(tree_, solid_, rest);
      parts[i] = body_of(tree_, pieces[i]);
    });
    const double limit = 0.999 * giver.appraisal.worst;
    for (std::size_t i = 0; i < rests.size(); ++i) {
      if (rests[i].appraisal.worst >= limit) continue;
      for (std::size_t to = 0; to < bodies.size(); ++to)
        if (to != from && touch(parts[i], bodies[to], solid_)) deals.push_back({i, to});
    }
    parallel_loop(std::size_t{0}, deals.size(), [&](std::size_t i) {
      Deal& d = deals[i];
      d.worst = std::max(distance_of_union(bodies[d.to], parts[d.leaf], solid_, limit),
                         rests[d.leaf].appraisal.worst);
    });
    const auto best = std::min_element(
        deals.begin(), deals.end(), [](const Deal& a, const Deal& b) { return a.worst < b.worst; });
    if (best == deals.end() || best->worst >= limit) return false;
    Body larger = union_of(bodies[best->to], parts[best->leaf], solid_);
    if (larger.appraisal.worst >= limit) return false;
    bodies[best->to] = std::move(larger);
    bodies[from] = std::move(rests[best->leaf]);
    return true;
  }

  /// Parts a body and a neighbour anew, by a plane that leaves both nearer to the solid than this
  /// share of the body's distance.
  bool part_anew(std::vector<Body>& bodies, std::size_t from, double share = 0.98) {
    const double limit = share * bodies[from].appraisal.worst;
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (i != from && touch(bodies[from], bodies[i], solid_)) near.push_back(i);
    std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
      const double x = bodies[a].appraisal.worst, y = bodies[b].appraisal.worst;
      return x != y ? x < y : a < b;
    });
    if (near.size() > 6) near.resize(6);
    CutTree::Split best;
    std::size_t with = from;
    for (const std::size_t i : near) {
      const auto split = tree_.find_split(nodes_of(bodies[from], bodies[i]),
                                          bodies[from].box.center() - bodies[i].box.center(),
                                          std::min(limit, best.worst));
      if (!split) continue;
      best = *split;
      with = i;
    }
    if (with == from) return false;
    std::vector<int> lower, upper;
    tree_.split(nodes_of(bodies[from], bodies[with]), best.plane, lower, upper);
    if (lower.empty() || upper.empty()) return false;
    Body a = union_of(tree_, solid_, lower), b = union_of(tree_, solid_, upper);
    if (std::max(a.appraisal.worst, b.appraisal.worst) > limit) return false;
    bodies[from] = std::move(a);
    bodies[with] = std::move(b);
    return true;
  }

  /// Where the worst body cannot be helped: parts those that are nearly as far anew, each with a
  /// neighbour. Chains of bodies are evened out like that, step by step.
  bool even_out(std::vector<Body>& bodies) {
    const double limit = 0.85 * worst_of(bodies);
    bool changed = false;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (bodies[i].appraisal.worst > limit) changed = part_anew(bodies, i, 0.99) || changed;
    return changed;
  }

  [[nodiscard]] std::vector<int> nodes_of(const Body& a, const Body& b) const {
    std::vector<int> out = nodes_of(a, 1);
    for (const int node : nodes_of(b, 1)) out.push_back(node);
    std::sort(out.begin(), out.end());
    return out;
  }

  /// Moves leaves of the worst body to others, or takes it apart and merges others instead, while
  /// that helps.
  void refine(std::vector<Body>& bodies, std::size_t target, bool chains = true) {
    for (int round = 0; round < tuning_.refinements && !bodies.empty(); ++round) {
      if (spent(kImproving)) return;
      std::size_t worst = 0;
      for (std::size_t i = 1; i < bodies.size(); ++i)
        if (bodies[i].appraisal.worst > bodies[worst].appraisal.worst) worst = i;
      const double limit = bodies[worst].appraisal.worst;
      if (hand_over(bodies, worst) || part_anew(bodies, worst)) continue;
      const std::vector<Body> parts = take_apart(bodies[worst], limit);
      if (parts.size() < 2) {
        if (chains && even_out(bodies)) continue;
        return;
      }
      std::vector<Body> changed;
      for (std::size_t i = 0; i < bodies.size(); ++i)
        if (i != worst) changed.push_back(bodies[i]);
      changed.insert(changed.end(), parts.begin(), parts.end());
      bool better = false;
      for (const double bulk : tuning_.bulks) {
        std::vector<Body> fewer = merged(changed, target, 0.999 * limit, bulk);
        better = fewer.size() <= target && worst_of(fewer) < limit;
        if (!better) continue;
        bodies = std::move(fewer);
        break;
      }
      if (!better && !(chains && even_out(bodies))) return;
    }
  }

  /// At most this many bodies, not finished yet; none where twice `epsilon` is not reached.
  std::vector<Body> gather(std::size_t target, double epsilon = kUnbounded) {
    begin_search();
    if (target == 1 && options_.method == Method::Planes) return {body_of(tree_, 0)};
    std::vector<std::vector<Body>> snapshots;
    // Few bodies need relatively more pieces to choose from.
    const auto pieces = [target](double multiple) {
      const double few = 8;
      return std::ceil(multiple * (static_cast<double>(target) + few) - few);
    };
    const double most = pieces(tuning_.multiples.back());
    for (const double multiple : tuning_.multiples) {
      const double wished = pieces(multiple);
      while (static_cast<double>(tree_.leaf_count()) < wished && !spent(kCutting) &&
             tree_.cut_worst())
        report("cutting", 0.7 * static_cast<double>(tree_.leaf_count()) / most);
      snapshots.push_back(leaf_bodies(static_cast<std::size_t>(wished)));
    }
    report("merging", 0.7);
    if (options_.method == Method::Clusters) return clustered(target, kUnbounded);
    // What refinement gains is a guess.
    std::vector<Body> bodies = best_merge(snapshots, target, 2 * epsilon);
    if (bodies.empty() && epsilon == kUnbounded) bodies = merged(leaf_bodies(), target, kUnbounded);
    refine(bodies, target, epsilon == kUnbounded);
    return bodies;
  }

  /// At most `target` bodies from clusters of triangles whose hulls are within `epsilon`, where
  /// that is unbounded.
  std::vector<Body> clustered(std::size_t target, double epsilon) {
    std::vector<Body> bodies =
        bodies_of_clusters(tree_, solid_, cluster_triangles(solid_, target, epsilon));
    // Clusters that do not touch.
    if (epsilon == kUnbounded && bodies.size() > target)
      bodies = merged(std::move(bodies), target, kUnbounded);
    return bodies;
  }

  std::vector<Finished> at_most(std::size_t target) {
    std::vector<Body> bodies = gather(target);
    const double free_cost = 0.5 * options_.simplify * worst_of(bodies);
    std::vector<Finished> finished;
    // What measuring finds is refined once more.
    for (int round = 0; round < tuning_.rounds; ++round) {
      if (round > 0 && target > 1) refine(bodies, target);
      report("simplifying", 0.75 + 0.02 * round);
      std::vector<Finished> next = finish(bodies, free_cost);
      bool misjudged = false;
      bodies.clear();
      for (const Finished& f : next) {
        learn(f);
        bodies.push_back(f.body);
        Appraisal& a = bodies.back().appraisal;
        if (f.reach.lower <= 1.02 * a.worst) continue;
        a.worst = f.reach.lower;
        a.at = f.reach.at;
        misjudged = true;
      }
      if (finished.empty() || reach_of(next) < reach_of(finished)) finished = std::move(next);
      if (!misjudged || spent(kImproving)) break;
    }
    const int rounds = target > 1 ? tuning_.refinements / 3 : 0;
    for (int round = 0; round < rounds; ++round) {
      report("refining", 0.8 + 0.2 * round / rounds);
      if (spent(kImproving) || !improve(finished, target, free_cost)) break;
    }
    return finished;
  }

  /// Takes the body with the largest certified distance apart, and merges others instead. @return
  /// false when that did not help.
  bool improve(std::vector<Finished>& finished, std::size_t target, double free_cost) {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < finished.size(); ++i)
      if (finished[i].reach.lower > finished[worst].reach.lower) worst = i;
    const double limit = finished[worst].reach.upper;
    const std::vector<Body> parts = take_apart(finished[worst].body, limit);
    if (parts.size() < 2) return false;
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < finished.size(); ++i)
      if (i != worst) bodies.push_back(finished[i].body);
    bodies.insert(bodies.end(), parts.begin(), parts.end());
    bodies = merged(std::move(bodies), target, 0.95 * limit);
    if (bodies.size() > target) return false;
    // Bodies that stayed need not be finished again.
    std::map<std::vector<int>, std::size_t> known;
    for (std::size_t i = 0; i < finished.size(); ++i)
      if (i != worst) known.emplace(finished[i].body.leaves, i);
    std::vector<Body> fresh;
    std::vector<std::size_t> kept;
    for (Body& b : bodies) {
      const auto at = known.find(b.leaves);
      if (at != known.end()) {
        kept.push_back(at->second);
      } else {
        fresh.push_back(std::move(b));
      }
    }
    std::vector<Finished> changed = finish(fresh, free_cost, limit);
    for (const Finished& f : changed)
      if (f.reach.upper >= 0.995 * limit) return false;
    for (const std::size_t i : kept) changed.push_back(std::move(finished[i]));
    finished = std::move(changed);
    return true;
  }

  /// So many bodies that no search brings them down to the limits.
  [[nodiscard]] std::size_t hopeless() const {
    const std::size_t by_vertices = options_.max_total_vertices.value_or(kUnlimited) / 4;
    const std::size_t limit = std::min(options_.max_bodies.value_or(kUnlimited), by_vertices);
    return limit > kUnlimited / 4 ? kUnlimited : 4 * limit;
  }

  /// Bodies within epsilon, one only where that suffices; none when even the first are more than
  /// `most`.
  std::vector<Finished> within(double epsilon, std::size_t most = kUnlimited) {
    if (std::vector<Finished> one = hull_within(epsilon); !one.empty()) return one;
    begin_search();
    const double wished = 0.93 * epsilon;
    const std::size_t least = options_.method == Method::Planes ? 2 : 1;
    std::vector<Body> best;
    const double begin = std::max(tree_.worst(), epsilon);
    std::size_t most_leaves = 6000;
    for (const double threshold : tuning_.thresholds) {
      while (tree_.worst() > threshold * wished && tree_.leaf_count() < most_leaves &&
             !spent(kCutting) && tree_.cut_worst())
        report("cutting", 0.6 * std::clamp(std::log(begin / std::max(tree_.worst(), 1e-300)) /
                                               std::log(begin / (0.5 * wished)),
                                           0.0, 1.0));
      if (options_.method == Method::Clusters) {
        best = clustered(1, wished);
        continue;
      }
      std::size_t fewest = 0;
      std::vector<Body> parts;
      for (const int node : tree_.nodes_within(0.5 * threshold * wished))
        parts.push_back(body_of(tree_, node));
      for (const double bulk : tuning_.bulks) {
        if (!best.empty() && spent(kImproving)) break;
        std::vector<Body> bodies = merged(parts, least, wished, bulk);
        fewest = fewest == 0 ? bodies.size() : std::min(fewest, bodies.size());
        if (best.empty() || bodies.size() < best.size()) best = std::move(bodies);
      }
      if (fewest > most) return {};
      most_leaves = std::max<std::size_t>(200, 8 * fewest);
    }
    report("simplifying", 0.6);
    return settle(std::move(best), epsilon, std::numeric_limits<std::size_t>::max());
  }

  /// Finishes bodies; those too far from the solid are taken apart, until all are within epsilon or
  /// there are more than `most`.
  std::vector<Finished> settle(std::vector<Body> best, double epsilon, std::size_t most) {
    const double wished = 0.93 * epsilon;
    std::vector<Finished> out;
    const std::size_t most_bodies = std::min(most, 200 + 8 * best.size());
    for (int round = 0; round < 30 && !best.empty() && best.size() + out.size() <= most_bodies;
         ++round) {
      std::vector<Finished> tried = finish(best, options_.simplify * wished, epsilon);
      best.clear();
      std::vector<Body> misjudged;  // leaves of bodies that were thought to be nearer
      for (Finished& f : tried) {
        // Parts of what was too thin are no thicker.
        if (f.reach.upper <= epsilon || (f.thickened && f.body.appraisal.worst <= wished)) {
          out.push_back(std::move(f));
          continue;
        }
        if (spent(kFinishing)) {
          out.push_back(std::move(f));
          continue;
        }
        const bool learnt = learn(f);
        // Where the vertices allowed are too few, or the leaf itself is too far.
        std::vector<Body> parts = take_apart(f.body, wished, learnt);
        if (parts.size() < 2) {
          out.push_back(std::move(f));
        } else {
          auto& to = learnt ? misjudged : best;
          std::move(parts.begin(), parts.end(), std::back_inserter(to));
        }
      }
      for (Body& b : merged(std::move(misjudged), 1, wished)) best.push_back(std::move(b));
      report("simplifying", 0.6 + 0.013 * (round + 1));
    }
    if (!best.empty())
      for (Finished& f : finish(best, 0)) out.push_back(std::move(f));
    return out;
  }

  /// Where a body reaches farther than samples told, that place is sampled from now on. @return
  /// whether it was one of the body before simplification.
  bool learn(const Finished& f) {
    if (f.reach.lower <= 1.02 * f.body.appraisal.worst) return false;
    const Solid::Probe probe{f.reach.at, f.reach.lower};
    if (!solid_.add_probe(probe, f.body.hull)) return false;
    memo_ = {};
    tree_.reappraise(probe);
    return true;
  }

  /// Looks for fewer bodies within epsilon, by bisection of the number allowed, until there are
  /// `enough`; one alone has been tried.
  void reduce(std::vector<Finished>& bodies, double epsilon, std::size_t enough = 1) {
    if (!good(bodies, epsilon)) return;
    std::size_t low = std::max<std::size_t>(1, bodies.size() / 3);
    while (bodies.size() > low + 1 + bodies.size() / 40 && bodies.size() > enough &&
           !spent(kImproving)) {
      const std::size_t middle = (low + bodies.size()) / 2;
      if (!replace(bodies, middle, epsilon)) low = middle;
    }
  }

  /// Shares out bodies among their neighbours, small ones first, while that keeps these within
  /// epsilon; one alone has been tried.
  void dissolve(std::vector<Finished>& bodies, double epsilon) {
    if (!good(bodies, epsilon)) return;
    std::sort(bodies.begin(), bodies.end(), [](const Finished& a, const Finished& b) {
      const double x = a.body.appraisal.volume, y = b.body.appraisal.volume;
      return x != y ? x < y : a.body.leaves < b.body.leaves;
    });
    for (std::size_t i = 0; i < bodies.size() && bodies.size() > 2 && !spent(kImproving);) {
      report("dissolving", 0.99);
      if (!share_out(bodies, i, epsilon)) ++i;
    }
  }

  /// Gives the pieces of a body to its neighbours. @return whether these stay within epsilon, which
  /// is one body less.
  bool share_out(std::vector<Finished>& bodies, std::size_t which, double epsilon) {
    const double limit = 0.93 * epsilon;
    const Body& body = bodies[which].body;
    std::vector<Body> takers;
    std::vector<std::size_t> origin;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (i == which || !touch(body, bodies[i].body, solid_)) continue;
      takers.push_back(bodies[i].body);
      origin.push_back(i);
    }
    if (takers.empty()) return false;
    std::vector<int> pieces = nodes_of(body, 16);
    for (std::size_t from = 0; pieces.size() < 6 && from < pieces.size();) {
      const int leaf = pieces[from];
      if (tree_.nodes()[leaf].stuck || !tree_.cut(leaf)) {
        ++from;
        continue;
      }
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(from));
      tree_.leaves_below(leaf, pieces);
    }
    const std::size_t count = takers.size();
    std::vector<Body> gifts;
    gifts.reserve(pieces.size());
    for (const int leaf : pieces) gifts.push_back(body_of(tree_, leaf));
    // How far each taker would be with each piece; those too far stay so as the takers grow.
    std::vector<double> worst(gifts.size() * count);
    const auto join = [&](std::size_t piece, std::size_t to) {
      double& w = worst[piece * count + to];
      if (w <= limit) w = distance_of_union(takers[to], gifts[piece], solid_, limit);
    };
    const auto best_of = [&](std::size_t piece) {
      const auto of = worst.begin() + static_cast<std::ptrdiff_t>(piece * count);
      return std::min_element(of, of + static_cast<std::ptrdiff_t>(count)) - worst.begin();
    };
    for (std::size_t piece = 0; piece < gifts.size(); ++piece) {
      parallel_loop(std::size_t{0}, count, [&](std::size_t to) { join(piece, to); });
      if (worst[best_of(piece)] > limit) return false;
    }
    std::vector<char> given(gifts.size(), 0), changed(count, 0);
    for (std::size_t left = gifts.size(); left > 0; --left) {
      std::ptrdiff_t best = -1;
      for (std::size_t piece = 0; piece < gifts.size(); ++piece) {
        if (given[piece] != 0) continue;
        const std::ptrdiff_t deal = best_of(piece);
        if (worst[deal] > limit) return false;
        if (best < 0 || worst[deal] < worst[best]) best = deal;
      }
      const std::size_t taken = best / count, to = best % count;
      takers[to] = union_of(takers[to], gifts[taken], solid_);
      given[taken] = changed[to] = 1;
      parallel_loop(std::size_t{0}, gifts.size(), [&](std::size_t piece) {
        if (given[piece] == 0) join(piece, to);
      });
    }
    std::vector<Body> fresh;
    std::vector<std::size_t> place;
    for (std::size_t i = 0; i < count; ++i) {
      if (changed[i] == 0) continue;
      fresh.push_back(std::move(takers[i]));
      place.push_back(origin[i]);
    }
    std::vector<Finished> finished = finish(fresh, options_.simplify * limit, epsilon);
    if (!good(finished, epsilon)) return false;
    for (std::size_t i = 0; i < place.size(); ++i) bodies[place[i]] = std::move(finished[i]);
    bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(which));
    return true;
  }

  /// Other bodies within epsilon if there are fewer, looked for by merging down to `target`.
  /// @return whether there are that few.
  bool replace(std::vector<Finished>& bodies, std::size_t target, double epsilon) {
    if (target == 0) return false;
    std::vector<Body> rough = gather(target, epsilon);
    // Some too far are taken apart.
    const auto far = static_cast<std::size_t>(std::count_if(
        rough.begin(), rough.end(), [&](const Body& b) { return b.appraisal.worst > epsilon; }));
    if (rough.empty() || rough.size() + far >= bodies.size()) return false;
    std::vector<Finished> fewer = settle(std::move(rough), epsilon, bodies.size() - 1);
    if (fewer.size() >= bodies.size() || !good(fewer, epsilon)) return false;
    bodies = std::move(fewer);
    return bodies.size() <= target;
  }

  /// Two or more bodies in place of one; all its pieces, if wished.
  std::vector<Body> take_apart(const Body& body, double epsilon, bool all = false) {
    std::vector<Body> leaves;
    if (body.leaves.size() == 1) {
      const int leaf = body.leaves[0];
      const CutTree::Node& node = tree_.nodes()[leaf];
      const bool cut = node.lower >= 0 || node.upper >= 0;
      // Where only the vertices allowed are too few, any smaller parts will do.
      const bool near = !all && node.appraisal.worst <= 0.5 * epsilon;
      if (!cut && !(near && tree_.halve(leaf)) && (node.stuck || !tree_.cut(leaf))) return {};
      for (const int child : {tree_.nodes()[leaf].lower, tree_.nodes()[leaf].upper})
        if (child >= 0) leaves.push_back(body_of(tree_, child));
      if (leaves.size() == 1) return take_apart(leaves[0], epsilon, all);
      return leaves;
    }
    for (const int node : nodes_of(body, kPieces, epsilon)) leaves.push_back(body_of(tree_, node));
    if (all) return leaves;
    return merged(std::move(leaves), 2, epsilon);
  }

  /// Simplifies, rounds outwards and measures. @param decisive  where given, it is told of every
  /// body whether it reaches farther; else only the largest reach is exact.
  std::vector<Finished> finish(std::vector<Body>& bodies, double free_cost, double decisive = 0) {
    std::vector<Finished> out(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) out[i].body = std::move(bodies[i]);
    find_required(out);
    std::vector<std::size_t> open(bodies.size());
    std::iota(open.begin(), open.end(), std::size_t{0});
    std::vector<Simplified> shapes(bodies.size());
    // Where simplification took too much, no vertex more than needed is left out.
    for (const bool first : {true, false}) {
      std::vector<Mesh> hulls(open.size());
      std::vector<char> thickened(open.size(), 0);
      parallel_loop(std::size_t{0}, open.size(), [&](std::size_t i) {
        const Body& body = out[open[i]].body;
        Simplified& shape = shapes[open[i]];
        if (first) {
          if (!body.appraisal.flat)
            shape = simplify(body.hull, options_.max_vertices, free_cost, solid_);
          hulls[i] = rounded(body, shape, options_.max_vertices);
        } else {
          hulls[i] = rounded(body, {shape.needed, 0, {}}, options_.max_vertices);
        }
        if (options_.min_thickness > 0) thickened[i] = thicken(hulls[i]) ? 1 : 0;
      });
      const ReachOptions reach = reach_options(hulls.size());
      const std::vector<Reach> measured =
          measure(hulls, solid_, reach, 0.5 * decisive, decisive > 0 ? 0.7 * decisive : kUnbounded);
      std::vector<std::size_t> failed;
      for (std::size_t i = 0; i < open.size(); ++i) {
        Finished& f = out[open[i]];
        if (f.hull.vertices.empty() || measured[i].upper < f.reach.upper) {
          f.hull = std::move(hulls[i]);
          f.reach = measured[i];
          f.thickened = thickened[i] != 0;
        }
        if (decisive > 0 && f.reach.upper > decisive &&
            shapes[open[i]].needed.size() > shapes[open[i]].vertices.size())
          failed.push_back(open[i]);
      }
      open = std::move(failed);
      if (open.empty()) break;
    }
    return out;
  }

  /// How bodies are measured: fewer pieces of each where the work left is little, and for all no
  /// more than what is kept for the end, but some.
  [[nodiscard]] ReachOptions reach_options(std::size_t bodies) const {
    constexpr double kPiece = 20'000;  // work
    const double kept = (1 - kFinishing) * solid_.work().most();
    const double fewest = std::clamp(
        kept / (kPiece * static_cast<double>(std::max<std::size_t>(1, bodies))), 100.0, 2000.0);
    ReachOptions out;
    out.absolute_gap = 1e-5 * solid_.diagonal();
    const double left = solid_.work().most() - static_cast<double>(solid_.work().done());
    const double share = left / (kPiece * static_cast<double>(std::max<std::size_t>(1, bodies)));
    if (share < static_cast<double>(out.most))
      out.most = static_cast<std::size_t>(std::max(fewest, share));
    // Pieces that take longer than usual are fewer.
    out.work = static_cast<std::uint64_t>(kPiece) * out.most;
    return out;
  }

  /// The points that a leaf's body has to contain, each leaf's once.
  void find_required(const std::vector<Finished>& bodies) {
    std::vector<int> open;
    for (const Finished& f : bodies)
      for (const int leaf : leaves_of(f.body))
        if (required_.try_emplace(leaf).second) open.push_back(leaf);
    std::vector<std::vector<Vec3>*> place;
    place.reserve(open.size());
    for (const int leaf : open) place.push_back(&required_.at(leaf));
    parallel_loop(std::size_t{0}, open.size(), [&](std::size_t i) {
      *place[i] = outer_points(tree_.nodes()[open[i]].piece, point_error_);
    });
  }

  /// The body as few nodes of the tree that are within a distance, but at least as many as wished
  /// where it has as many leaves.
  [[nodiscard]] std::vector<int> nodes_of(const Body& body, std::size_t wished,
                                          double distance = kUnbounded) const {
    const auto& nodes = tree_.nodes();
    const auto children = [&](int node) {
      std::vector<int> out;
      tree_.append_children(node, out);
      return out;
    };
    const std::vector<int> leaves = leaves_of(body);
    std::set<int, std::greater<>> whole(leaves.begin(), leaves.end());
    // Parents come before their children in the tree, and so after them here.
    for (auto it = whole.begin(); it != whole.end(); ++it) {
      const int parent = nodes[*it].parent;
      if (parent < 0) continue;
      const std::vector<int> parts = children(parent);
      if (std::all_of(parts.begin(), parts.end(), [&](int part) { return whole.contains(part); }))
        whole.insert(parent);
    }
    std::vector<int> coarsest;
    for (const int node : whole)
      if (!whole.contains(nodes[node].parent)) coarsest.push_back(node);
    std::vector<int> out = tree_.nodes_within(distance, std::move(coarsest));
    while (out.size() < wished) {
      auto largest = out.end();
      for (auto it = out.begin(); it != out.end(); ++it)
        if (!children(*it).empty() &&
            (largest == out.end() ||
             nodes[*it].appraisal.volume > nodes[*largest].appraisal.volume))
          largest = it;
      if (largest == out.end()) break;
      const std::vector<int> parts = children(*largest);
      out.erase(largest);
      out.insert(out.end(), parts.begin(), parts.end());
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  [[nodiscard]] std::vector<int> leaves_of(const Body& body) const {
    std::vector<int> out;
    for (const int node : body.leaves) tree_.leaves_below(node, out);
    return out;
  }

  /// Makes a body as thick as wished. @return whether it was not.
  bool thicken(Mesh& hull) const {
    if (geom::least_width(hull, options_.min_thickness).lower >= options_.min_thickness)
      return false;
    hull = bcd::thicken(std::move(hull), options_.min_thickness, options_.max_vertices, solid_);
    return true;
  }

  [[nodiscard]] static std::size_t vertices_of(const std::vector<Finished>& bodies) {
    std::size_t sum = 0;
    for (const Finished& f : bodies) sum += f.hull.vertices.size();
    return sum;
  }
  /// Whether the limits of bodies and vertices hold.
  [[nodiscard]] bool fits(const std::vector<Finished>& bodies) const {
    return !bodies.empty() && bodies.size() <= options_.max_bodies.value_or(kUnlimited) &&
           vertices_of(bodies) <= options_.max_total_vertices.value_or(kUnlimited);
  }

  /// The bodies with the smallest distance found that keep to both limits; else those with the
  /// fewest vertices.
  std::vector<Finished> nearest_that_fit() {
    const std::size_t total = *options_.max_total_vertices;
    const std::size_t most =
        std::min(options_.max_bodies.value_or(kUnlimited), std::max<std::size_t>(1, total / 6));
    // Fewer bodies reach farther, but leave more vertices to each.
    std::vector<Finished> best;
    std::size_t last = 0;
    for (double share = 1; share > 0.1; share *= 0.75) {
      const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(most)));
      if (count == last) continue;
      if (!best.empty() && spent(kImproving)) break;
      last = count;
      std::vector<Finished> tried = at_most(count);
      if (!best.empty() && fits(best) && reach_of(tried) > reach_of(best)) break;
      thin_to(tried, total);
      if (best.empty() || (fits(tried) ? !fits(best) || reach_of(tried) < reach_of(best)
                                       : vertices_of(tried) < vertices_of(best)))
        best = std::move(tried);
    }
    if (!tuning_.reduce || !fits(best)) return best;
    // By epsilon: those too far are taken apart, and fewer looked for.
    int tries = 6;
    for (double step = 0.08; step > 0.015 && tries > 0 && !spent(kImproving); --tries) {
      const double epsilon = (1 - step) * reach_of(best);
      if (!(epsilon > 1e-5 * solid_.diagonal())) break;
      std::vector<Finished> tried = within(epsilon);
      for (const std::size_t enough : {most, std::size_t{1}}) {
        const bool looked = tried.size() > enough || enough == 1;
        if (looked) {
          reduce(tried, epsilon, enough);
          dissolve(tried, epsilon);
        }
        thin_out(tried, epsilon);
        // Once there are few bodies, still fewer have only somewhat fewer vertices.
        const bool near =
            static_cast<double>(vertices_of(tried)) < 1.15 * static_cast<double>(total);
        if (fits(tried) || tried.size() > most || (looked && !near)) break;
      }
      if (fits(tried) && reach_of(tried) < reach_of(best)) {
        best = std::move(tried);
      } else {
        step *= 0.5;
      }
    }
    return best;
  }

  /// At most this many vertices, with the smallest distance that allows it.
  void thin_to(std::vector<Finished>& bodies, std::size_t total) {
    if (vertices_of(bodies) <= total) return;
    const auto thinned = [&](double epsilon) {
      std::vector<Finished> out = bodies;
      thin_out(out, epsilon);
      return out;
    };
    double low = std::max(reach_of(bodies), 1e-4 * solid_.diagonal()), high = low;
    std::vector<Finished> best = thinned(high);
    while (vertices_of(best) > total && high < solid_.diagonal()) {
      low = high;
      high *= 1.5;
      best = thinned(high);
    }
    while (vertices_of(best) <= total && high > 1.02 * low) {
      const double middle = std::sqrt(low * high);
      std::vector<Finished> tried = thinned(middle);
      if (vertices_of(tried) <= total) {
        high = middle;
        best = std::move(tried);
      } else {
        low = middle;
      }
    }
    bodies = std::move(best);
  }

  /// As few vertices as epsilon allows each body, by bisection of their number.
  void thin_out(std::vector<Finished>& bodies, double epsilon) {
    struct Open {
      std::size_t body, low;
    };
    find_required(bodies);  // leaves may have been cut since the bodies were finished
    std::vector<Open> open;
    for (std::size_t i = 0; i < bodies.size(); ++i) open.push_back({i, 3});
    for (;;) {
      if (spent(kFinishing)) return;
      std::erase_if(
          open, [&](const Open& o) { return bodies[o.body].hull.vertices.size() <= o.low + 1; });
      if (open.empty()) return;
      ReachOptions reach = reach_options(open.size());
      reach.enough = std::max(epsilon, reach_of(bodies));
      std::vector<Mesh> hulls(open.size());
      parallel_loop(std::size_t{0}, open.size(), [&](std::size_t i) {
        const Finished& f = bodies[open[i].body];
        const std::size_t most = (open[i].low + f.hull.vertices.size()) / 2;
        hulls[i] = rounded(f.body, simplify(f.body.hull, most, 0, solid_), most);
      });
      const std::vector<Reach> measured =
          measure(hulls, solid_, reach, 0.5 * epsilon, 0.7 * epsilon);
      for (std::size_t i = 0; i < open.size(); ++i) {
        Finished& f = bodies[open[i].body];
        const std::size_t tried = (open[i].low + f.hull.vertices.size()) / 2;
        if (hulls[i].vertices.size() <= tried &&
            measured[i].upper <= std::max(epsilon, f.reach.upper)) {
          f.hull = std::move(hulls[i]);
          f.reach = measured[i];
        } else {
          open[i].low = tried;
        }
      }
    }
  }

  /// A body's simplified hull rounded outwards.
  [[nodiscard]] Mesh rounded(const Body& body, const Simplified& shape, std::size_t most) const {
    std::vector<Vec3> required;
    for (const int leaf : leaves_of(body)) {
      const auto& points = required_.at(leaf);
      required.insert(required.end(), points.begin(), points.end());
    }
    ensure(!required.empty(), "a body that has to contain nothing");
    geom::HullBuilder builder;
    if (builder.build(required)) {
      std::vector<Vec3> hull;
      for (const std::uint32_t v : builder.vertices()) hull.push_back(required[v]);
      required = std::move(hull);
    }
    if (!body.appraisal.flat) {
      if (auto hull = push_out(shape.vertices, required, most)) return *std::move(hull);
      if (shape.needed.size() > shape.vertices.size())
        if (auto hull = push_out(shape.needed, required, most)) return *std::move(hull);
    }
    return enclose(body.hull, required, most);
  }

  const DecomposeOptions& options_;
  Tuning tuning_;
  Solid solid_;
  CutTree tree_;
  PairMemo memo_;
  bool begun_ = false, out_of_work_ = false;
  double point_error_ = 0;
  std::map<int, std::vector<Vec3>> required_;  // by leaf
  DecomposeResult result_;
};

/// The distance that counts is the one to the mesh that was not simplified.
void measure_anew(DecomposeResult& result, const Mesh& closed) {
  const Solid solid(closed, 2000, 0);
  std::vector<Mesh> hulls;
  for (const geom::ConvexBody& body : result.bodies) hulls.push_back(body.hull);
  ReachOptions options;
  options.absolute_gap = 1e-5 * solid.diagonal();
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
  [[nodiscard]] double left() const { return static_cast<double>(std::max(left_, all_ / 4)); }
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
  constexpr std::size_t kFew = 2000;  // triangles
  DecomposeResult best = search(closed, options, allowance);
  if (!options.epsilon || options.max_total_vertices || options.method != Method::Planes ||
      options.effort == Effort::Fast || closed.triangles.size() > kFew ||
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

double default_work(std::size_t triangles) {
  return 20 + 1e-3 * std::max(0.0, static_cast<double>(triangles) - 1e4);
}

double work_allowed(const DecomposeOptions& options, std::size_t triangles) {
  return options.max_work.value_or(options.effort == Effort::Best
                                       ? std::numeric_limits<double>::infinity()
                                       : default_work(triangles));
}

void require_sound(const DecomposeOptions& options) {
  if (!options.epsilon && !options.max_bodies && !options.max_total_vertices)
    throw Error(ErrorCode::InvalidArgument,
                "neither epsilon nor max_bodies nor max_total_vertices is given");
  if (options.epsilon && !(*options.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument, "epsilon must be positive");
  if (options.max_total_vertices && *options.max_total_vertices < 8)
    throw Error(ErrorCode::InvalidArgument, "max_total_vertices must be at least 8");
  if (options.max_bodies && *options.max_bodies == 0)
    throw Error(ErrorCode::InvalidArgument, "max_bodies must be at least 1");
  if (options.max_vertices < 8)
    throw Error(ErrorCode::InvalidArgument, "fewer than 8 vertices per body");
  if (!(options.min_thickness >= 0) || !std::isfinite(options.min_thickness))
    throw Error(ErrorCode::InvalidArgument, "the least thickness must be finite and not negative");
  if (options.max_work && !(*options.max_work > 0))
    throw Error(ErrorCode::InvalidArgument, "max_work must be positive");
  if (!(options.simplify >= 0 && options.simplify <= 1))
    throw Error(ErrorCode::InvalidArgument, "the share for simplification must be from 0 to 1");
  if (options.max_total_vertices && options.min_thickness > 0)
    throw Error(ErrorCode::InvalidArgument,
                "a limit on all vertices together does not go with a least thickness: bodies are "
                "simplified after they are thickened");
}

bool too_coarse(const Mesh& mesh, const DecomposeOptions& options) {
  double magnitude = 0;
  for (const Vec3& p : mesh.vertices) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  const double spacing = geom::float32_spacing(magnitude);
  // Rounding outwards takes some spacings.
  return spacing > (options.epsilon ? std::min(1e-4 * geom::bounding_box(mesh).diagonal(),
                                               0.01 * *options.epsilon)
                                    : 1e-6 * geom::bounding_box(mesh).diagonal());
}

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
