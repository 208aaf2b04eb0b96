#pragma once

#include <kaboum/geom/prepare.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/inclusion.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::verify {

/// The mesh that claims about the triangles of a file are about: as prepared or, where preparing
/// refuses them, as they are.
struct Subject {
  geom::Mesh mesh;  ///< whose solid is judged
  /// True if it is not known which solid is meant: preparing refuses the mesh or had to guess. What
  /// each part that is closed by itself winds round, either way, is to be held as well.
  bool both_ways = false;
  /// Preparing left out triangles, or split quads that are not plane one way: `triangles` are to
  /// lie inside as well.
  bool has_more = false;
  geom::Mesh triangles;  ///< with has_more: held_triangles and, of such quads, the other ways
  geom::PreparationReport report;  ///< where it was prepared
  /// The last triangles of `mesh`, which close holes. They bound its solid, but none of them is in
  /// the file: they need not lie inside themselves.
  std::size_t filled_triangles = 0;
  bool is_prepared = false;  ///< else which solid the triangles bound is not known at all
  std::string refusal;       ///< why it could not be prepared; empty: it was, or nobody tried
};

/// A subject of triangles that were prepared.
Subject subject_of(const geom::Mesh& file, const geom::Prepared& prepared);

/// Prepares the triangles of a file.
/// @throws Error as geom::prepare where sheets were to be dropped, and on other errors than
///   InvalidInput
Subject prepared_subject(const geom::Mesh& file, const geom::PrepareOptions& options);

/// The triangles as they are, whichever way they are oriented.
/// @param quads  geom::PrepareOptions::quads: they are to lie inside split the other way as well
Subject unprepared_subject(const geom::Mesh& file, const std::vector<std::uint32_t>& quads = {});

/// Claims about a subject, and the meshes that they are about.
struct SubjectClaims {
  Inclusion inclusion;
  std::optional<geom::Mesh> solid_part;  ///< the solid claim is that of this part of the subject
  bool surface_of_all = false;           ///< the surface claim is that of Subject::triangles
};

/// Decides what a subject's mesh as it is oriented does not settle: what each part that is closed
/// by itself winds round; its triangles without those that close holes, and those left out.
/// @param mesh   Subject::mesh, wherever it is kept
/// @param first  what was decided of the mesh
/// @param look   decides of a mesh, or of its surface alone, whether it is inside
SubjectClaims decide_rest(
    const Subject& subject, const geom::Mesh& mesh, Claims claims, Inclusion first,
    const std::function<Inclusion(const geom::Mesh&, bool surface_only)>& look);

/// Reference of distances from a subject: its solid and all triangles of the file.
struct MeasuredMesh {
  geom::Mesh mesh;  ///< that of the subject; else with each triangle once more the other way round
  bool has_solid = true;  ///< false: which solid the triangles bound is not known
};

MeasuredMesh measured_mesh(const Subject& subject, const geom::Mesh& file);

/// The triangles of a file that are to lie inside whatever is its solid: all but sheets that were
/// dropped on request.
geom::Mesh held_triangles(const geom::Mesh& file, const geom::Prepared& prepared);

/// The index in the file of a triangle of held_triangles.
std::uint32_t source_of_held(const Subject& subject, std::uint32_t triangle);

/// The connected parts of a mesh that are closed by themselves and no sheets; those whose boxes do
/// not meet are in one mesh together.
std::vector<geom::Mesh> closed_parts(const geom::Mesh& mesh);

/// The mesh without its last triangles, which close holes.
geom::Mesh without_filling(geom::Mesh mesh, std::size_t filled_triangles);

/// With all triangles the other way round.
geom::Mesh turned(geom::Mesh mesh);

}  // namespace kaboum::verify
