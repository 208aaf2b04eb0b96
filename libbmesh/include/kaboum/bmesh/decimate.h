#pragma once

#include <kaboum/bmesh/log.h>
#include <kaboum/geom/solid_mesh.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::bmesh {

/// Cost of an edge contraction. [gaschler2016] §4.3.2, §4.3.3.
enum class Cost {
  Distance,        ///< the measured distance between result and original, both ways: the maximum
  Mean,            ///< squared distances to the planes around, integrated over their area
  Planes,          ///< sum of squared distances to the planes around, Eq. 4.4, 4.5
  PlanesAdapted,   ///< the same with the constant term adapted
  PlanesDiagonal,  ///< the same with all coefficients adapted, Eq. 4.6, 4.7
  Triangles,       ///< sum of squared distances to the triangles' centres
};

/// Effort for tightness besides contracting. Anything but Fast needs a closed mesh (or
/// Direction::Any) and excludes keep_convex: see `possible_effort`.
enum class Effort {
  Fast,  ///< nothing
  /// Vertices are pulled back towards the original and edges flipped, in some rounds; with
  /// Cost::Distance the last edges are contracted together with moves of the vertices around.
  Normal,
  Best,  ///< the same in more rounds; with Cost::Distance more edges are contracted in this way
};

/// Default of DecimateOptions::sharp_angle. [degrees]
inline constexpr double kSharpAngle = 90;

/// Numbers that result vertices are made of.
enum class Precision { Float, Double };

/// The defaults are the thesis's: quick, and the same for every mesh, for callers that decimate in
/// passing. bmesh-decimate's are Cost::Distance and Effort::Normal, for results that are kept.
struct DecimateOptions {
  Direction direction = Direction::Outer;
  Cost cost = Cost::Planes;
  Effort effort = Effort::Fast;
  bool as_printed = false;  ///< PlanesDiagonal only: the thesis's formulas that are known wrong
  Precision precision = Precision::Float;
  std::optional<std::size_t> vertices;  ///< stop at this many vertices
  std::optional<double> epsilon;        ///< keep both one-sided distances within this. [length] > 0
  bool keep_convex = false;             ///< convex in, convex out, exactly
  /// Ends decimation after so much work, counted in steps that take about so many seconds of one
  /// core: the result does not depend on the machine or the number of threads. After three fifths
  /// vertices are pulled back no more, and costs are not measured; in the end nothing is contracted
  /// any more. Default: 12, and 2 for each 1000 triangles beyond 10,000; no limit with
  /// Effort::Best. [s] > 0
  std::optional<double> max_work;
  /// Edges whose faces' normals differ by more than this also cost the distance to the plane
  /// through them across their mean normal ([gaschler2016] §4.3.5), against spikes off knife edges.
  /// Costs Planes, PlanesAdapted and PlanesDiagonal only; by default `kSharpAngle`. [degrees]
  std::optional<double> sharp_angle;
  bool record_steps = false;  ///< for a log: DecimateResult::steps
  /// Called now and then with the current number of vertices; may throw to cancel.
  std::function<void(std::size_t vertices)> progress;
};

/// options.max_work, or the default for this mesh; infinite: no end. [s]
double work_allowed(const geom::SolidMesh& input, const DecimateOptions& options);

/// options.effort, or Fast where more cannot be made for this mesh and `decimate` refuses it.
Effort possible_effort(const geom::SolidMesh& input, const DecimateOptions& options);

/// Why decimation ended.
enum class Stop {
  VertexTarget,  ///< the number of vertices asked for is reached
  ErrorBound,    ///< no contraction is left; epsilon alone forbids at least one that is otherwise
                 ///< valid
  Exhausted,     ///< no contraction is left at all
  OutOfWork,     ///< max_work was reached before any of these
};

struct DecimateStatistics {
  std::size_t vertices_in = 0, vertices_out = 0;
  std::size_t contractions = 0;
  std::size_t moves = 0;              ///< single vertices moved to representable coordinates
  std::size_t pull_backs = 0;         ///< vertices moved back towards the original
  std::size_t flips = 0;              ///< edges flipped
  std::uint64_t placements = 0;       ///< minimisations solved
  std::uint64_t predicates = 0;       ///< exact orientation tests
  std::uint64_t exact_fallbacks = 0;  ///< of these, decided by exact arithmetic
  // Candidates rejected, by reason.
  std::uint64_t rejected_topology = 0;     ///< would pinch the surface
  std::uint64_t rejected_no_position = 0;  ///< no position satisfies the planes
  std::uint64_t rejected_predicate = 0;    ///< the rounded position fails an exact test
  std::uint64_t rejected_fold = 0;         ///< a triangle would turn over or collapse
  std::uint64_t rejected_distance = 0;     ///< would leave epsilon
  std::uint64_t rejected_spike = 0;        ///< would stick out far beyond need (Distance only)
  std::uint64_t rejected_original = 0;  ///< would cut into the original, or could not be certified
};

struct DecimateResult {
  geom::Mesh mesh;
  Stop stop = Stop::Exhausted;
  DecimateStatistics statistics;
  /// Vertices that precision Float was asked for but that have no certified float32 position
  /// nearby (never any with Precision::Double). The mesh is valid, but not representable in
  /// float32.
  std::size_t unrepresentable = 0;
  double work = 0;           ///< done, of what max_work allows; of a series: until this result. [s]
  bool out_of_work = false;  ///< max_work ended a part of it: with more, it might be nearer
  /// With record_steps: those that lead to it from the input, or from the result before in a
  /// series.
  std::vector<Step> steps;
};

/// Single-sided decimation by edge contraction. Source: [gaschler2016] Alg. 1, Alg. 2.
///
/// Every contraction is accepted only after exact orientation tests of the new, already rounded
/// vertex against the plane of every triangle it replaces. So the winding number never falls
/// (Outer) or never rises (Inner) anywhere off the surfaces: docs/algorithms/bounding-mesh.md has
/// the theorem. Inner results of closed meshes do not fold, either: their triangles stay in the
/// input's solid if its own do. Vertices on the border of an open mesh do not move. With `epsilon`,
/// every contraction also keeps a certificate that no point of either surface is farther than
/// epsilon from the other one.
///
/// @pre options.vertices or options.epsilon is given.
/// @throws Error{InvalidArgument} on contradictory options, and on those that would have no effect:
///   as_printed or sharp_angle with a cost that does not use them, an effort that cannot be made;
///   Error{InvalidInput} when keep_convex is asked for input that is not convex.
DecimateResult decimate(const geom::SolidMesh& input, const DecimateOptions& options);

/// The same for several numbers of vertices in one pass. The results are nested: each encloses
/// (Inner: is enclosed by) the one before, of closed meshes their solids, as both do the original;
/// docs/algorithms/bounding-mesh.md, "Series". Statistics count from the beginning. A result that
/// is not reached stands for all after it.
///
/// @param vertices  falling; options.vertices must not be given.
/// @throws as `decimate` does; Error{InvalidArgument} when `vertices` is empty or does not fall.
std::vector<DecimateResult> decimate_series(const geom::SolidMesh& input,
                                            const DecimateOptions& options,
                                            std::span<const std::size_t> vertices);

}  // namespace kaboum::bmesh
