#pragma once

#include <kaboum/geom/prepare.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::verify {

/// The mesh that claims about the triangles of a file are about: as prepared or, where preparing
/// refuses them, as they are.
struct Subject {
  geom::Mesh mesh;  ///< whose solid is judged
  /// Which solid is meant is not known, for preparing refuses the mesh or had to guess: what each
  /// part that is closed by itself winds round, either way, is to be held as well.
  bool both_ways = false;
  /// Preparing left out triangles, or split quads that are not plane one way: `triangles` are to
  /// lie inside as well.
  bool has_more = false;
  geom::Mesh triangles;  ///< with has_more: held_triangles and, of such quads, the other ways
  geom::PreparationReport report;  ///< where it was prepared
  /// The last triangles of `mesh`, which close holes. They bound its solid, but none of them is in
  /// the file: they need not lie inside themselves.
  std::size_t filled_triangles = 0;
  std::string refusal;  ///< why it could not be prepared; empty: it was
};

/// Prepares the triangles of a file.
/// @throws Error as geom::prepare where sheets were to be dropped, and on other errors than
///   InvalidInput
Subject prepared_subject(const geom::Mesh& file, const geom::PrepareOptions& options);

/// The triangles as they are, whichever way they are oriented.
Subject unprepared_subject(const geom::Mesh& file);

/// What distances from a subject are measured to: its solid and all triangles of the file.
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

/// The connected parts of a mesh that are closed by themselves; those whose boxes do not meet are
/// in one mesh together.
std::vector<geom::Mesh> closed_parts(const geom::Mesh& mesh);

/// The mesh without its last triangles, which close holes.
geom::Mesh without_filling(geom::Mesh mesh, std::size_t filled_triangles);

/// With all triangles the other way round.
geom::Mesh turned(geom::Mesh mesh);

}  // namespace kaboum::verify
