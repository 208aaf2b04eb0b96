#pragma once

#include <kaboum/base/length.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/certify/certified.h>
#include <kaboum/certify/subject.h>
#include <kaboum/certify/wrap.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/region.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for a set of convex bodies. Inner sets have the SearchSettings of it, and refuse the
/// other settings of covers.
struct SetRequest : bcd::CoverSettings {
  /// Outer: the bodies cover the solid. Inner: each lies in it.
  enum class Direction { Outer, Inner } direction = Direction::Outer;
  /// Polytopes; spheres (closed balls); or, of outer sets, capsules, boxes, or whichever of these
  /// three takes least to be queried (Mixed). All but polytopes take of the other settings of
  /// covers `max_bodies` and `effort`.
  enum class BodyKind {
    Polytopes,
    Spheres,
    Capsules,
    Boxes,
    Mixed
  } body_kind = BodyKind::Polytopes;
  /// Spheres within epsilon: the same number, as near as it was found to allow.
  bool nearest = false;
  /// Spheres within epsilon: more are not searched for, with an error instead (LimitReached). What
  /// is found does not depend on it.
  std::size_t most_spheres = bcd::kMostBalls;
  /// Farthest that a point of an outer set may be from the solid, or deepest that a point left out
  /// by an inner set may be. By default 1 % where no limit is given, else none.
  std::optional<Length> epsilon;
  /// Of outer sets with an epsilon: points of the bodies that lie in a region are within the
  /// region's own one, which counts where it is less. In the coordinates of what is decomposed.
  std::vector<geom::RequestedRegion> regions;
  /// Least width of the bodies (bcd::CoverOptions::min_thickness), as a length or a percentage of
  /// the diagonal.
  std::optional<Length> thickness;

  /// certify_file multiplies the file's coordinates by it first (io::scale).
  double scale = 1;
  /// Holes are filled or refused; kept ones are filled as well.
  geom::PrepareOptions preparation{.holes = geom::Holes::Fill};
  /// Set: what is covered is a wrap round all triangles (certify_wrap), whatever they are like, or
  /// only where that is needed (`where_needed`). How far it is from them counts towards epsilon,
  /// and so does its clearance. Outer sets only; `farthest`, `float32` and `progress` are not
  /// looked at.
  std::optional<WrapRequest> wrap;
  /// certify_file wraps the triangles of CAD files, which stand for exact faces, of itself, so that
  /// an outer set holds these. False: what is claimed is about the triangles.
  bool hold_exact_faces = true;

  // What the container says of itself.
  std::string source;  ///< name of the file
  std::string unit = "m", frame;

  /// epsilon, or what stands for it.
  [[nodiscard]] std::optional<Length> wanted_epsilon() const;
  /// The options that the bodies depend on, as bcd-decompose spells them: the container's record.
  [[nodiscard]] std::string parameters() const;
};

/// The request in the unit of a file's vertices: its unit is that one, and lengths that state
/// another are brought into it.
/// @param unit   of the vertices; empty: the file does not say, and the request's own is taken
/// @param notes  gets what of that a user should know
/// @throws Error{InvalidArgument} where a length states a unit, and there is none.
SetRequest in_unit_of_file(SetRequest request, const std::string& unit,
                           std::vector<std::string>& notes);

/// Certificate of a set. A claim only as part of a CertifiedSet.
struct SetCertificate {
  SetRequest::Direction direction = SetRequest::Direction::Outer;
  bcd::Stop stop = bcd::Stop::Done;
  std::size_t bodies = 0, vertices = 0, largest_body_vertices = 0;
  /// Certified bracket of the largest distance from a point of the set to the solid (outer), or of
  /// the depth of what is left out (inner). [length]
  double distance_lower = 0, distance_upper = 0;
  /// Inner sets of spheres: that no point deeper than distance_upper is left out was decided from
  /// the bytes, too. Of other inner sets the search has bounded it.
  bool depth_decided = false;
  double diagonal = 0;      ///< of the prepared input's bounding box [length]
  Subject subject;          ///< what is covered, or encloses
  double largest_hole = 0;  ///< longest diagonal of a hole's box [length]
  std::size_t filled_triangles = 0, pieces = 0, pre_step_triangles = 0, thickened = 0;
  double min_thickness = 0;        ///< asked for [length]
  double max_aspect = 0;           ///< asked for; 0: none
  std::size_t max_facets = 0;      ///< of each body, asked for; 0: no limit
  std::size_t most_facets = 0;     ///< that a body has (geom::float32_facet_count), with that limit
  double safety = 1;               ///< allowance for rounding with which the exact check passed
  bool out_of_work = false;        ///< with more work the search might do better
  std::vector<std::string> notes;  ///< of preparation: what a user should know of the input
  /// A region of the request: no point of the bodies in it is farther than `epsilon`.
  struct Region {
    std::string name;
    double epsilon = 0;   ///< [length]
    bool reached = true;  ///< false: no body has a point in it
  };
  std::vector<Region> regions;
  /// Why it is not known that an outer set holds all that the triangles, which are inside, are
  /// meant to bound; empty: it does.
  std::string undecided;
  /// The wrap's certificate, where the solid is that of a wrap. Distances are then to the solid or
  /// to the triangles of the input (within its clearance: the surface that they stand for),
  /// whichever is nearer.
  std::optional<WrapCertificate> wrap;

  /// True if epsilon, if asked for, is reached, within all limits.
  [[nodiscard]] bool reached() const { return stop == bcd::Stop::Done; }
};

/// A set that was serialised, read back, and decided exactly by libverify to be what it should be.
/// Its bytes are a GLB container.
using CertifiedSet = Certified<geom::ConvexSet, SetCertificate>;

/// What is claimed of it: that its bodies are convex and cover the solid and every triangle, or lie
/// in it.
Certificate certificate_of(const CertifiedSet& set);

/// As in reports of bcd-decompose, with the claims and what they are about: a JSON object.
std::string to_json(const CertifiedSet& set);

/// Callbacks of long work. Both may be empty; called from the calling thread.
struct Hooks {
  std::function<void(const std::string& stage)> progress;  ///< often; may throw to cancel
  std::function<void(const std::string& text)> note;       ///< things a user should know
};

/// Searches for bodies, writes them as a GLB container and reads that back. Then libverify decides
/// exactly that they are convex and cover the solid and every triangle (outer), or lie in the solid
/// (inner) and, of spheres, leave out nothing deeper than stated. Where that fails the search is
/// repeated, without its pre-step, then with larger allowances for rounding.
///
/// @param mesh    as read; it is prepared, or wrapped, here.
/// @param sha256  of the file it was read from, for the record.
/// @return nullopt when float32 cannot hold bodies as near as asked for: too far from the origin,
/// or
///   epsilon too small.
/// @throws Error{InvalidInput} as geom::prepare, certify_wrap and the search;
///   Error{InvalidArgument} on contradictory options; Error{Internal} when no polytopes pass the
///   exact check, Error{LimitReached} when no bodies of another kind do.
std::optional<CertifiedSet> certify_set(const geom::Mesh& mesh, const std::string& sha256,
                                        const SetRequest& request, const Hooks& hooks = {});

}  // namespace kaboum::certify
