#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/region.h>
#include <kaboum/geom/solid_mesh.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::bcd {

/// Effort of the search.
enum class Effort { Fast, Normal, Best };

/// Choice of simplifying the input to a bounding mesh first ([gaschler2016] §4.4.2): within a tenth
/// of epsilon, which the bodies' distance to the input includes.
enum class PreStep {
  Auto,  ///< above 20,000 triangles, if a quarter of the vertices suffices
  On,
  Off
};

/// Progress of a decomposition.
struct Progress {
  std::string stage;
  double fraction;  ///< estimate of the share of the work done, 0 to 1
};

/// Limits and effort of a search of either kind, outwards or inwards.
struct SearchSettings {
  /// Most bodies. With epsilon: fewest bodies within it, and if these are too many, the best that
  /// this many allow.
  std::optional<std::size_t> max_bodies;
  std::size_t max_vertices = 64;  ///< per body, ≥ 8
  Effort effort = Effort::Normal;
  /// Most work of the search. Steps are counted, each as long as it takes on one core of a machine
  /// of 2020, so the result is the same on any machine, however fast or busy. Then the search ends
  /// with the best found, measured like any other. What comes before and after (a pre-step, the
  /// exact check) does not count. [s] By default `default_work` of the triangles, or without limit
  /// for Effort::Best.
  std::optional<double> max_work;
};

/// Settings of a search outwards: those that depend on no mesh, and that a request for a certified
/// set has as well (certify::SetRequest).
struct CoverSettings : SearchSettings {
  /// Most vertices of all bodies together, ≥ 8; otherwise like max_bodies, and together with it:
  /// the smallest distance with which both hold. Not with min_thickness.
  std::optional<std::size_t> max_total_vertices;
  /// Most facets of a body, ≥ 6, counted as geom::float32_facet_count does. max_vertices holds as
  /// well. Not with max_total_vertices, min_thickness or max_aspect.
  std::optional<std::size_t> max_facets;
  /// No two points of a body are farther apart than so many times its least width, ≥ 4: what is
  /// too thin for its length is thickened in the same way. Not with max_total_vertices.
  std::optional<double> max_aspect;
  /// Share of a body's distance, 0 to 1, that leaving out vertices may take; with less, bodies have
  /// more vertices and are nearer to the solid on the whole, not at most. By default 0.5.
  std::optional<double> simplify;
  /// Within epsilon, fewer bodies are looked for until the search has done so much work in all; by
  /// default while max_work allows. [s]
  std::optional<double> improve_work;
  PreStep pre_step = PreStep::Auto;

  [[nodiscard]] double simplify_share() const { return simplify.value_or(0.5); }
};

/// One run of a search: what it is to reach on a certain mesh, and who watches.
struct SearchRun {
  /// Outwards: largest distance allowed from a point of the bodies to the solid and its triangles.
  /// Inwards: largest depth allowed of what is in no body. [length]
  std::optional<double> epsilon;
  /// Outwards, with epsilon: points of the bodies that lie in a region are no farther than the
  /// region's own epsilon, where that is less. Not with a limit on the bodies, or on the vertices
  /// of all.
  std::vector<geom::BoundedRegion> regions;
  /// Multiplies what is allowed for rounding (the overlap of pieces, the error of computed points);
  /// larger where an exact check of the result fails.
  double safety = 1;
  /// Called now and then, from the calling thread; may throw to cancel.
  std::function<void(const Progress&)> progress;
};

/// Request for find_cover.
struct CoverOptions : CoverSettings, SearchRun {
  /// Bodies are at least this wide in every direction, for engines that shrink hulls; thinner ones
  /// are thickened, which counts towards epsilon. [length]
  double min_thickness = 0;
};

/// Why a search ended.
enum class Stop {
  Done,           ///< epsilon, if given, is reached, and so are the limits given
  TooManyBodies,  ///< epsilon is not reached with max_bodies or max_total_vertices, or these are
                  ///< too few for anything
  TooCoarse,      ///< float32's spacing here exceeds epsilon/100 or 1e-6 of the diagonal; no bodies
  Stuck,          ///< epsilon is not reached though everything was tried
  OutOfWork,      ///< epsilon is not reached with max_work
};

struct CoverStatistics {
  std::size_t leaves = 0;              ///< pieces that the input was cut into
  std::size_t filled_triangles = 0;    ///< that closed an open input
  std::size_t pre_step_triangles = 0;  ///< of the bounding mesh that was decomposed; 0: none
  std::size_t vertices = 0;            ///< of all bodies
  std::size_t largest = 0;             ///< vertices of the largest body
  std::size_t thickened = 0;           ///< bodies that min_thickness or max_aspect changed
  bool out_of_work = false;            ///< max_work ended the search: with more, it might do better
};

/// 20 s, and 1 s per thousand triangles beyond ten thousand. [s]
double default_work(std::size_t triangles);

/// Result of find_cover. No claim that it covers: certify::certify_set decides that.
struct CoverCandidate {
  std::vector<geom::ConvexBody> bodies;
  Stop stop = Stop::Done;
  /// Certified bracket of the largest distance from a point of the bodies to the input's solid and
  /// triangles. [length]
  double excess_lower = 0, excess_upper = 0;
  CoverStatistics statistics;
};

/// Searches for convex bodies whose union contains the input's solid and every triangle of it.
///
/// The solid is cut by planes into cells. What of it lies in a cell is contained in the hull of the
/// clipped triangles and of the cell's corners that lie in the solid. Hulls are merged while the
/// distance to the solid allows, their vertices reduced by contractions that only enlarge them, and
/// rounded outwards to float32. Source: [gaschler2016] §4.4; docs/algorithms/convex-
/// decomposition.md has the covering argument, and which of its steps are left to an exact check of
/// what is written (verify::verify_cover).
///
/// An open input is closed first by fans over its holes; the solid is then that of the closed mesh.
///
/// Bodies are exactly convex, with float32 coordinates; the same for any number of threads.
///
/// @pre epsilon, max_bodies or max_total_vertices is given.
/// @throws Error{InvalidArgument} on contradictory options, Error{InvalidInput} when the mesh is
/// closed and all in one plane.
CoverCandidate find_cover(const geom::SolidMesh& input, const CoverOptions& options);

}  // namespace kaboum::bcd
