#pragma once

// Constants that steer the search for bodies round a solid. No claim rests on any of them: whatever
// the search finds is measured (excess.h) and decided exactly before it is written. Lengths are in
// the units of the input, work is in nanoseconds of one core (kaboum/base/work.h), shares are plain
// numbers. Where a comment names a test, it watches over what the constant is for; all were
// compared by numbers of bodies and time with benchmarks/bcd_table.

#include <kaboum/bcd/cover.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cut_tree.h"

namespace kaboum::bcd {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

// Work. Work.TheBestFoundIsGivenAndMeasuredWhenTheWorkIsDone.

/// Shares of the work allowed: after the first, no more pieces are cut; after the second, nothing
/// is improved; after the last, no body is split or simplified any more.
constexpr double kCutting = 0.4, kImproving = 0.7, kFinishing = 0.85;
/// About what measuring takes for each part that a body is cut into. [ns]
constexpr std::uint64_t kWorkPerPart = 20'000;
/// Parts of each body that measuring may look at where little work is left, however many bodies:
/// fewer leave brackets too wide to tell bodies apart, and more would not end in time.
constexpr double kFewestParts = 100, kEnoughParts = 2000;

// Accuracy.

/// Searches aim at this share of epsilon: simplification and rounding take some of the rest, and
/// distances of the search are samples.
constexpr double kAimedShare = 0.93;
/// Measuring ends where the bracket is narrower than this share of the solid's diagonal.
constexpr double kMeasuredGap = 1e-5;
/// Distances below the first share of epsilon need no measuring; where the largest is known to be
/// some length, up to epsilon, those below the second share of it need none (excess.h).
constexpr double kMeasuredFloor = 0.5, kWorthMeasuring = 0.97;
/// A body is farther than samples told if a certified distance exceeds theirs by this factor.
constexpr double kMisjudged = 1.02;
/// Error of a computed point, as a share of the largest coordinate, with `safety` 1
/// (docs/algorithms/convex-decomposition.md, "Rounding").
constexpr double kPointError = 0x1p-40;

// Cutting and merging.

/// To n bodies, the input is cut into m (n + kFewBodies) − kFewBodies pieces, m of
/// Tuning::multiples: few bodies need relatively more pieces to choose from.
constexpr double kFewBodies = 8;
/// Most leaves of the first threshold; of the next ones, so many times the bodies found, and no
/// fewer than the last. (A soup of triangles would be cut without end.)
constexpr std::size_t kMostLeaves = 6000, kLeavesPerBody = 8, kLeastMostLeaves = 200;
/// Merging begins with the coarsest nodes within this share of the distance that is aimed at:
/// nearer ones only cost time.
constexpr double kMergedFrom = 0.5;
/// Weight of the added volume in the cost of a merge, unless several are tried (Tuning).
constexpr double kVolumeWeight = 0.05;
/// Bonus of cuts into halves where a number of bodies is given: SearchOptions::halving_bonus.
constexpr double kHalvingBonus = 0.1;
/// Bodies not finished yet may be so many times as far as allowed: what refinement and splitting
/// gain is a guess.
constexpr double kRoughFactor = 2;

// Local search (local_search.h).

/// A body is looked at as this many nodes of the tree, if it has as many leaves: finer ones, which
/// every attempt makes more of, took up to six times as long for distances a few percent different.
constexpr std::size_t kPieces = 24;
/// A move has to leave all bodies that it changes below this share of the worst distance, else it
/// goes to and fro by rounding.
constexpr double kMoveGain = 0.999;
/// The same for two neighbours that are split anew: a search among leaves is dearer than a move.
constexpr double kResplitGain = 0.98;
/// Neighbours of a body, nearest to the solid first, that it is tried to be split with anew.
constexpr std::size_t kResplitNeighbours = 6;
/// Chains: bodies beyond this share of the worst distance are split anew with neighbours, and any
/// gain will do. Decompose.ThinRingsDistanceFallsWithTheSquareOfTheNumberOfBodies.
constexpr double kChainFrom = 0.85, kChainGain = 0.99;
/// A leaf within this share of the distance needs more vertices, not a better cut: it is halved.
/// Decompose.FewVerticesPerBodyReachEpsilonWithMoreBodies.
constexpr double kHalvedBelow = 0.5;

// A given number of bodies (count_search.h).

/// Share of the worst body's distance that simplification may add, with CoverOptions::simplify.
constexpr double kFreeShare = 0.5;
/// Rounds of replacing the worst finished body, for each so many of Tuning::refinements.
constexpr int kRefinementsPerRound = 3;
/// Merges in place of the worst finished body have to be below the first share of its distance, and
/// what is finished below the second.
constexpr double kReplacedMerge = 0.95, kReplacedGain = 0.995;

// Within epsilon (epsilon_search.h).

/// A search for bodies within epsilon is given up, for one that keeps to the limits, where it finds
/// so many times as many at first. A body has no fewer than kLeastVertices.
constexpr std::size_t kHopeless = 4, kLeastVertices = 4;
/// Rounds of splitting what is too far, and most bodies then: so many more, and times as many, as
/// there were. Decompose.WallsThinnerThanTheGridAndFlatParts.
constexpr int kSplitRounds = 30;
constexpr std::size_t kMoreBodies = 200, kTimesBodies = 8;
/// Bisection for fewer bodies begins at one of so many, and ends where one of so many is left to
/// gain.
constexpr std::size_t kReduceFrom = 3, kReduceUntil = 40;

// Removing bodies (body_removal.h).

/// A body's pieces for its neighbours: so many nodes, if it has as many leaves; leaves are cut to
/// have at least the second number.
constexpr std::size_t kRemovedPieces = 16, kLeastRemovedPieces = 6;

// A limit on all vertices together (vertex_budget.h). Decompose.LimitOfAllVerticesTogether.

/// Bodies have this many vertices on the average at least: no more bodies are tried than the limit
/// allows of these.
constexpr std::size_t kVerticesPerBody = 6;
/// Numbers of bodies tried: shares of the most, each so many times the last, down to the least.
constexpr double kBudgetShare = 0.75, kLeastBudgetShare = 0.1;
/// Then distances are tried, smaller by a share that is halved where one fails, between these; so
/// many times at most, down to a share of the diagonal.
constexpr double kBudgetStep = 0.08, kLeastBudgetStep = 0.015, kLeastBudgetDistance = 1e-5;
constexpr int kBudgetTries = 6;
/// Beyond this factor of the limit, fewer bodies have only somewhat fewer vertices: not looked for.
constexpr double kNearBudget = 1.15;
/// The distance that a number of vertices takes: searched for from a share of the diagonal up, by
/// factors of the second number, until it is known to the third.
constexpr double kLeastThinned = 1e-4, kThinnedGrowth = 1.5, kThinnedRatio = 1.02;
/// No hull of a solid has this few vertices: where bisection of their number begins.
constexpr std::size_t kTooFewVertices = 3;

// Several searches (decompose.cpp).

/// Inputs of at most so many triangles are also searched quickly: much hangs on the first cuts.
constexpr std::size_t kQuickTriangles = 2000;
/// Every search may do this share of all work, whatever the ones before have done.
constexpr std::uint64_t kLeastWorkShare = 4;
/// Nodes of the grid where only certified distances are measured: they rest on none of it.
constexpr std::size_t kMeasuringGrid = 2000;
/// Nodes where it is guessed which points no body holds both of (body_bound.h).
constexpr std::size_t kBoundGrid = 20000;

/// What effort changes.
struct Tuning {
  std::size_t grid;  ///< nodes of the solid's grid of distances
  SearchOptions search;
  std::vector<double> multiples;       ///< of the bodies asked for, that the input is cut into
  std::vector<double> thresholds;      ///< of epsilon, that leaves are cut down to
  std::vector<double> volume_weights;  ///< of the added volume when merging, tried in turn
  std::size_t first_weights;           ///< so many of these for the first bodies within epsilon
  int refinements;                     ///< rounds of changing the worst body
  int rounds;                          ///< of refining what measuring finds
  bool reduce = false;                 ///< look for fewer bodies within epsilon
  std::size_t counted = kUnlimited;    ///< by their number, where they are no more than this
  /// Work without a body less, as a share of all before, after which no fewer are looked for.
  double patience = kUnbounded;
};

Tuning tuning(Effort effort);
/// The tuning of a quick search; fast effort is the one without mirrors.
/// @param mirrors  try planes of symmetry
Tuning quick_tuning(bool mirrors);

}  // namespace kaboum::bcd
