#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/subject.h>

#include <optional>
#include <string>
#include <vector>

#include "mesh.h"

/// The files that `bound-verify mesh` and `cover` judge.
namespace kaboum::tools {

struct MeshInput {
  geom::Mesh mesh;
  std::string sha256;
  std::string unit;  ///< io::ReadResult::unit
  std::vector<std::string> notes;
  std::size_t filled_triangles = 0, dropped_sheets = 0;
  bool single_precision = false;  ///< io::ReadResult::single_precision
  std::string about_import = {};  ///< io::about_import
  double deviation = 0;           ///< of exact faces from the triangles; 0: there are none [length]
  std::string about_exact = {};   ///< what is to be known where the triangles stand for exact faces
  std::optional<verify::ExactPoints> exact = {};  ///< of these, where they are looked at
  /// How preparing splits quads that are not plane: as the programs that make results do.
  std::vector<std::uint32_t> quads = {};
  geom::PrepareOptions::Diagonal diagonal = geom::PrepareOptions::Diagonal::AsGiven;
  // If prepared: of what claims are, but for its mesh, and what distances of a cover are from.
  std::optional<verify::Subject> subject = {};
  std::optional<verify::MeasuredMesh> measured = {};
};

/// A mesh, or a set: `mesh` is the sum of its bodies then.
struct ApproximationInput : MeshInput {
  geom::ConvexSet set;
  bool is_set = false;
};

/// A mesh as bmesh-decimate and bcd-decompose prepare it: what they claim is about that.
/// @param fill  fill its holes, as both do by default.
/// @throws Error{InvalidInput} as geom::prepare.
geom::Prepared prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool fill);

/// @throws Error naming the file.
MeshInput read_original(const VerifyMeshOptions& options);

/// @throws Error naming the file; where the claims mean nothing for a set.
ApproximationInput read_approximation(const VerifyMeshOptions& options);

/// The original as the tools prepare it, without holes; where preparing refuses it and they wrap
/// it, as it is, with a note: all of its triangles are to be enclosed all the same.
/// @throws Error as prepare_original where sheets were to be dropped, and of inner claims, which
///   need a solid
void prepare(MeshInput& original, verify::Relation relation, bool drop_sheets);

/// What preparing would change of the original; empty if nothing.
std::string change_by_preparing(const MeshInput& original);

}  // namespace kaboum::tools
