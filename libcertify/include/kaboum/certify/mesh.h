#pragma once

#include <kaboum/base/length.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/certify/certified.h>
#include <kaboum/certify/float32_shortage.h>
#include <kaboum/certify/mesh_certificate.h>
#include <kaboum/certify/wrap.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for a bounding mesh and its file. At least one of vertices, ratio and
/// epsilon is given; the first one reached stops.
struct MeshRequest {
  /// Numbers of result vertices.
  enum class Numbers {
    Auto,  ///< float32, or double where float32 is too coarse and the format can hold it
    Float,
    Double,
  };

  bmesh::Direction direction = bmesh::Direction::Outer;
  /// Stop at this many vertices. Several, falling, are a series: each result encloses (Inner: is
  /// enclosed by) the one before.
  std::vector<std::size_t> vertices;
  std::optional<double> ratio;    ///< stop at this share of the original's vertices, in (0, 1)
  std::optional<Length> epsilon;  ///< keeps every point of either surface this near to the other
  bmesh::Cost cost = bmesh::Cost::Distance;
  bmesh::Effort effort = bmesh::Effort::Normal;  ///< as far as possible: MeshPlan::effort
  bool as_printed = false;                       ///< as bmesh::DecimateOptions
  bool keep_convex = false;                      ///< convex in, convex out, exactly
  std::optional<double> max_work;                ///< as bmesh::DecimateOptions [s]
  std::optional<double> sharp_angle;             ///< as bmesh::DecimateOptions [degrees]
  Numbers numbers = Numbers::Auto;
  io::Format format = io::Format::Ply;
  std::string comment = "KABouM";  ///< in the file, where the format has comments

  bool measure = true;  ///< brackets of distances, which epsilon and `decide` ask for anyway
  /// Has libverify decide all claims from the bytes. Otherwise they rest on the exact tests of
  /// every step.
  bool decide = true;
  bool record_steps = false;  ///< for a log or a progressive file

  /// True if double may stand in for float32.
  [[nodiscard]] bool may_be_double() const {
    return numbers == Numbers::Auto && io::holds_double(format);
  }
};

/// Limits that a request sets for one mesh.
struct MeshPlan {
  double diagonal = 0;                ///< of the bounding box [length]
  std::optional<double> epsilon;      ///< [length]
  std::vector<std::size_t> vertices;  ///< asked for, falling; none with epsilon alone
  bmesh::Precision precision = bmesh::Precision::Float;
  /// Then double takes its place, or nothing can be made: MeshRequest::may_be_double.
  std::optional<Float32Shortage> shortage;
  bmesh::Effort effort = bmesh::Effort::Fast;  ///< that is made: bmesh::possible_effort
  double work = 0;                             ///< allowed [s]
};

/// A mesh that was serialised, read back and compared, and what is certified of it. The bytes hold
/// it triangle by triangle.
using CertifiedMesh = Certified<geom::Mesh, MeshCertificate>;

/// All that is claimed; nothing of Direction::Any. The distance is Hausdorff's, where it was
/// measured.
Certificate certificate_of(const CertifiedMesh& mesh);

/// One result or a series.
struct MeshSeries {
  MeshPlan plan;
  /// Empty where float32 would not do and double was not allowed. A number of vertices that is not
  /// reached stands for all after it.
  std::vector<CertifiedMesh> meshes;
  std::optional<Float32Shortage> shortage;  ///< float32 does not do: as planned, or found later
  std::vector<bmesh::Step> steps;           ///< with record_steps
};

/// Callbacks of long work. All may be empty; called from the calling thread.
struct MeshHooks {
  std::function<void(const std::string& stage)> progress;  ///< often; may throw to cancel
  std::function<void()> found;  ///< candidates are found, certifying begins
  /// The solid is known, decimating begins; again where a wrap takes the place of the first one.
  std::function<void()> prepared = {};
};

/// geom::prepare, and refuses what would enclose nothing by itself: a flat sheet, closed by its own
/// fill.
/// @throws Error{InvalidInput}
geom::Prepared prepare_mesh(const geom::Mesh& mesh,
                            const geom::PrepareOptions& options = {.holes = geom::Holes::Fill});

/// Plan of what certify_meshes would do.
/// @throws Error{InvalidInput} when a percentage is no length; Error{InvalidArgument} on
///   contradictory requests.
MeshPlan plan_mesh(const geom::Prepared& original, const MeshRequest& request);

/// Decimates, and certifies what comes of it: serialised, read back and compared; distances
/// measured; claims decided by libverify from the bytes. Where float32 is too coarse, the numbers
/// are double if that is allowed. docs/algorithms/bounding-mesh.md has the proofs.
///
/// @throws Error{InvalidInput} as prepare_mesh, plan_mesh and bmesh::decimate;
///   Error{InvalidArgument} on contradictory requests; Error{Internal} when a claim is refuted, or
///   the bytes do not hold the mesh.
MeshSeries certify_meshes(const geom::Prepared& original, const MeshRequest& request,
                          const MeshHooks& hooks = {});

/// Ways to give the triangles of a mesh the solid that is bounded.
struct MeshPreparation {
  enum class Wrap {
    Never,
    /// Only if the mesh can be given no solid, or some triangle would not lie in an outer result.
    /// Only with Holes::Fill and without keep_orientation, for those say which solid is wanted.
    WhereNeeded,
    Always,  ///< outer results only
  };
  geom::PrepareOptions options{.holes = geom::Holes::Fill};
  Wrap wrap = Wrap::WhereNeeded;
  WrapRequest wrapping = {};  ///< `farthest`, `float32` and `progress` are not looked at
};

/// Bounding meshes of an input, and what was bounded.
struct BoundedMesh {
  geom::Prepared original;              ///< the input as prepared, or its wrap
  std::optional<WrapCertificate> wrap;  ///< of the input; the original is the wrap
  std::string why_wrapped;              ///< where that was not asked for
  std::string why_not_wrapped;          ///< where it was needed
  MeshSeries series;
  /// Why it is not known that outer results hold all that the triangles are meant to bound; empty:
  /// they do.
  std::string undecided;

  /// Decides whether all triangles of the input are in all results (outer), or all triangles of
  /// these in the input's solid (inner); Undefined where nothing is claimed.
  [[nodiscard]] verify::Answer surface_answer() const;
};

/// Notes for the user on how the input got its solid, in sentences.
std::vector<std::string> notes_of(const BoundedMesh& made);

/// Gives the mesh a solid, and bounds that by certify_meshes. With Wrap::WhereNeeded every triangle
/// of the input is in every outer result, or BoundedMesh::why_not_wrapped says what was in the way.
/// A wrap is what certify_wrap makes; how far it reaches counts towards epsilon.
///
/// @throws as prepare_mesh, certify_meshes and certify_wrap; Error{InvalidArgument} where a wrap is
///   asked for and other than outer results, or their steps.
BoundedMesh bound_mesh(const geom::Mesh& input, const MeshRequest& request,
                       const MeshPreparation& preparation = {}, const MeshHooks& hooks = {});

/// The same as certify_meshes for one result; certificate.stop says why it has no fewer vertices.
/// @return nullopt when float32 is too coarse, and double is not allowed.
/// @throws as certify_meshes; Error{InvalidArgument} when several numbers of vertices are asked
/// for.
std::optional<CertifiedMesh> certify_mesh(const geom::Prepared& original,
                                          const MeshRequest& request, const MeshHooks& hooks = {});

}  // namespace kaboum::certify
