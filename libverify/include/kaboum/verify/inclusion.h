#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::verify {

enum class Answer {
  Verified,   ///< true
  Refuted,    ///< false
  Undecided,  ///< a limit was reached before the claim was decided
  Undefined,  ///< means nothing for these meshes
};

const char* name_of(Answer answer);

/// Refuted before undecided before undefined before verified.
inline Answer worse(Answer a, Answer b) {
  for (const Answer x : {Answer::Refuted, Answer::Undecided, Answer::Undefined})
    if (a == x || b == x) return x;
  return Answer::Verified;
}

/// A point that shows that a claim is false.
struct Witness {
  geom::Vec3 point;
  /// Distance to the outer mesh, less the margin where there is one; rounded; infinite if the outer
  /// mesh has no area. [length]
  double depth = 0;
  /// The winding numbers at `point` were found by exact arithmetic and contradict the claim; for
  /// the surface claim the point is a corner of the inner mesh. Otherwise no such point with double
  /// coordinates was found, and `point` is the offending place, rounded.
  bool exact = false;
};

/// The answer to one claim.
struct Claim {
  Answer answer = Answer::Undefined;
  std::string reason;  ///< one clause; empty when verified
  std::optional<Witness> witness;
  /// Triangles that bound the offending regions.
  std::vector<std::uint32_t> inner_triangles, outer_triangles;
};

/// Work that deciding an inclusion is allowed where nobody says otherwise: many times what the most
/// tangled of real meshes takes, so that only what is made to be hard is left undecided. [s]
inline double usual_work(std::size_t triangles) {
  return 60 + 5e-3 * static_cast<double>(triangles);
}

struct InclusionOptions {
  std::size_t max_contacts = 100'000'000;  ///< pairs of triangles that touch, per kind
  std::size_t max_pairs = 4'000'000'000;   ///< pairs of triangles looked at, per kind
  std::size_t max_pieces = 2'000'000;      ///< pieces of lines within one triangle
  std::size_t max_cells = 4'000'000;       ///< boxes looked at for margins and depths, at most
  /// From this many coplanar overlaps on, the cells between them are settled by the meshes' own
  /// winding numbers instead of being sampled; the answers are the same.
  std::size_t settle_from = 1000;
  /// Decides the surface claim alone; the solid one is Undefined. Closed outer meshes only.
  bool surface_only = false;
  /// Ends after so much work, counted in steps that take at most about so many seconds of one core,
  /// so that the answer is the same on any machine; infinite: no end. Inclusion::left_out counts
  /// the triangles that were not decided. Absent: no end with surface_only, where triangles that
  /// few others cut are looked at first; else usual_work() of both meshes' triangles. [s]
  std::optional<double> max_work;
  /// Called with what is being done, from one thread.
  std::function<void(const std::string&)> progress{};
};

/// Result of verify_inclusion.
struct Inclusion {
  /// Solid claim. Closed meshes: {w_inner ≥ 1} ⊆ {w_outer ≥ 1} off the surfaces. Open ones with the
  /// same border: w_inner ≤ w_outer off the surfaces; `relative` is then true.
  Claim solid;
  bool relative = false;
  /// Surface claim: every triangle of the inner mesh lies in closure{w_outer ≥ 1}.
  Claim surface;

  bool inner_closed = true, outer_closed = true;
  std::size_t inner_open_edges = 0, outer_open_edges = 0;
  std::size_t triangles_without_area = 0;  ///< in both meshes; they bound nothing
  std::size_t contacts = 0;                ///< pairs of triangles in which one cuts the other
  std::size_t samples = 0;                 ///< winding numbers computed
  std::size_t left_out = 0;                ///< triangles of which a limit left the claim open
  bool limited = false;  ///< a limit ended the search; what is refuted may name too few triangles
};

/// Decides from the triangles alone whether one mesh encloses another, in exact arithmetic.
///
/// Z = {w_inner ≥ 1, w_outer ≤ 0} off the surfaces is open and bounded; if it is not empty, some
/// face of the inner mesh has its inner side in Z or some face of the outer mesh its outer side.
/// Every cell of every face is decided by an exact winding number on that side. Meshes may touch,
/// share faces, intersect themselves and be non-manifold. docs/algorithms/exact-inclusion.md has
/// the proof.
///
/// The result does not depend on the number of threads.
///
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite;
///   Error{InvalidArgument} unless max_work is above 0.
Inclusion verify_inclusion(const geom::Mesh& inner, const geom::Mesh& outer,
                           const InclusionOptions& options = {});

}  // namespace kaboum::verify
