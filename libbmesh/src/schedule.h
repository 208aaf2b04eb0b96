#pragma once

// When which part of a decimation begins and ends, as multiples of the number of vertices asked for
// and shares of lengths. No claim rests on any of these: every step is certified by itself
// (docs/algorithms/bounding-mesh.md). They were compared by the distances reached and the time
// taken, docs/algorithms/bounding-mesh.md, "Measured"; tests/bmesh/decimate_test.cpp holds that
// results stay as good.

#include <kaboum/bmesh/decimate.h>

#include <array>
#include <cstddef>

namespace kaboum::bmesh {

/// Distances are measured from this many times the number of vertices asked for on; before, they
/// are so small that the quadrics order the contractions as well.
constexpr std::size_t kMeasureFrom = 3;
/// The same by an error bound: from this share of it on.
constexpr double kMeasureFromEpsilon = 0.1;

/// From this multiple of the vertices asked for on, edges are contracted together with moves of the
/// vertices around, at first within the deviation reached, then within that much more from round to
/// round.
constexpr double kClusterFrom = 1.25, kClusterFromBest = 1.4, kClusterGrowth = 1.05;
constexpr int kClusterRounds = 36;

/// From these multiples of the vertices asked for on, and when edges are contracted together with
/// moves, the original is looked at between the samples, too: where it is farther from the mesh
/// than this share of the deviation reached. The first ones only if it has at most so many times
/// the vertices asked for; more are samples enough.
constexpr std::array<double, 2> kRefineAt{2.2, 1.7};
constexpr double kRefineFrom = 0.6, kRefineMost = 12;
/// And again when so many of a hundred vertices are gone since.
constexpr std::size_t kRefineAgain = 5;

/// Contractions and rounds of optimisation within an error bound take turns while each turn takes
/// more than this share of the vertices.
constexpr std::size_t kTurnPercent = 1;

/// Small meshes are decimated a second time, within a bound. Inwards, where steps are dear, and
/// with Effort::Best it begins at this share of the distance measured at kClusterFrom times the
/// vertices asked for.
constexpr double kBoundFromInner = 0.85, kBoundFromBest = 0.75;
/// Else at this share of the distance that a quick first time has reached, at the smaller one where
/// more than kBoundFew times as many vertices are there as are asked for. It rises by
/// kBoundGrowthAlone, and edges are contracted alone, down to this multiple of the vertices asked
/// for. Where the number is reached before it rises, it begins again at kBoundLowered of that,
/// up to kBoundTimes.
constexpr double kBoundFrom = 0.4, kBoundFromFew = 0.25;
constexpr std::size_t kBoundFew = 6;
constexpr double kBoundGrowthAlone = 1.04, kBoundLowered = 0.65;
constexpr double kBoundAlone = 1.2;
constexpr int kBoundTimes = 3;
/// Then it rises by kBoundGrowth from round to round, and they are contracted together with moves,
/// until the number is reached. Rounds that gain less than kBoundGain of what is missing raise it
/// by more.
constexpr double kBoundGrowth = 1.07, kBoundMostGrowth = 1.25, kBoundGain = 0.05;
constexpr int kBoundPasses = 1;  ///< rounds of optimisation in each
/// Small: at most so many vertices, and a third of them asked for at most.
constexpr std::size_t kBoundVertices = 4000, kBoundShare = 3;

/// Samples of the original lie no farther apart than this share of the error bound, within reason,
/// where contractions move the vertices around.
constexpr double kSpacing = 0.7;
/// But no more than so many are added; fewer where the error bound rises: it is no promise there.
constexpr double kSamples = 4000, kSamplesRising = 1500;

/// Rounds of optimisation, at most: in the end, and at each stage before.
constexpr int kFinalPasses = 6, kFinalPassesBest = 12, kStagePasses = 3;

/// An error bound that rises until the number of vertices asked for is reached. [length]
struct RisingBound {
  double from, to;
  /// Contractions alone raise it down to this multiple of the number.
  double alone;
};

/// The vertices from which on distances are measured, given the number asked for.
inline std::size_t measured_from(const DecimateOptions& options, std::size_t target) {
  const bool follows = options.cost == Cost::Distance ||
                       (options.cost == Cost::Mean && options.effort != Effort::Fast);
  return follows ? kMeasureFrom * target : target;
}

}  // namespace kaboum::bmesh
