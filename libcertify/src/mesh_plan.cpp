// What a request for a bounding mesh comes to: lengths in the mesh's unit, float32 or double,
// effort and work.

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>

#include "mesh_certifier.h"

namespace kaboum::certify {
namespace {

/// Neighbouring float32 numbers may be so far apart: of the diagonal, and of epsilon.
constexpr double kSpacingOfDiagonal = 1e-6, kSpacingOfEpsilon = 1e-2;
/// No closed mesh has fewer vertices.
constexpr std::size_t kLeastVertices = 4;

void require(bool condition, const char* message) {
  if (!condition) throw Error(ErrorCode::InvalidArgument, message);
}

void require_sound(const MeshRequest& r) {
  require(!r.vertices.empty() || r.ratio || r.epsilon,
          "a bounding mesh needs a number of vertices, a ratio or an epsilon");
  require(r.vertices.size() < 2 || !r.ratio, "a series cannot be joined with a ratio");
  require(!r.ratio || (*r.ratio > 0 && *r.ratio < 1), "a ratio must lie between 0 and 1");
  require(!r.decide || r.direction != bmesh::Direction::Any,
          "direction 'any' claims nothing that could be decided");
  require(r.numbers != MeshRequest::Numbers::Double || io::holds_double(r.format),
          "the format holds float32 only, and double is asked for");
  require(!r.as_printed || r.cost == bmesh::Cost::PlanesDiagonal,
          "as_printed is for the cost PlanesDiagonal only");
  require(!r.sharp_angle || r.cost == bmesh::Cost::Planes || r.cost == bmesh::Cost::PlanesAdapted ||
              r.cost == bmesh::Cost::PlanesDiagonal,
          "sharp_angle is for the costs of planes only");
}

std::optional<Float32Shortage> too_coarse(const geom::Box3& box, const MeshPlan& plan) {
  Float32Shortage shortage;
  shortage.limit = kSpacingOfDiagonal * plan.diagonal;
  if (plan.epsilon) shortage.limit = std::min(shortage.limit, *plan.epsilon * kSpacingOfEpsilon);
  shortage.spacing =
      geom::float32_spacing(std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
  if (shortage.spacing <= shortage.limit) return std::nullopt;
  return shortage;
}

}  // namespace

// Closed by its own fill, a flat sheet would be certified to lie in a solid that is nothing.
void require_extent(const geom::Prepared& original) {
  if (original.solid.filled_triangles() > 0 && !geom::convex_hull(original.solid.mesh().vertices))
    throw Error(ErrorCode::InvalidInput,
                "all triangles lie in one plane and enclose nothing; have a wrap give the sheet a "
                "thickness (--prepare wrap), or have bcd-decompose cover it");
}

geom::Prepared prepare_mesh(const geom::Mesh& mesh, const geom::PrepareOptions& options) {
  geom::Prepared prepared = geom::prepare(mesh, options);
  require_extent(prepared);
  return prepared;
}

bmesh::DecimateOptions search_options(const MeshRequest& request, const MeshPlan& plan) {
  bmesh::DecimateOptions d;
  d.direction = request.direction;
  d.cost = request.cost;
  d.keep_convex = request.keep_convex;
  d.effort = plan.effort;
  d.as_printed = request.as_printed;
  d.precision = plan.precision;
  d.sharp_angle = request.sharp_angle;
  d.epsilon = plan.epsilon;
  d.max_work = request.max_work;
  return d;
}

MeshPlan plan_mesh(const geom::Prepared& original, const MeshRequest& request) {
  require_sound(request);
  const geom::Box3 box = geom::bounding_box(original.solid.mesh());
  MeshPlan plan;
  plan.diagonal = box.diagonal();
  if (request.epsilon) {
    plan.epsilon = request.epsilon->of(plan.diagonal);
    if (!(*plan.epsilon > 0))
      throw Error(ErrorCode::InvalidInput, "a percentage of a mesh without extent is no length");
  }
  plan.vertices = request.vertices;
  if (request.ratio) {
    const auto n = static_cast<std::size_t>(
        std::ceil(*request.ratio * static_cast<double>(original.solid.mesh().vertices.size())));
    plan.vertices = {
        std::max({n, plan.vertices.empty() ? 0 : plan.vertices.front(), kLeastVertices})};
  }
  if (request.numbers == MeshRequest::Numbers::Double) {
    plan.precision = bmesh::Precision::Double;
  } else {
    plan.shortage = too_coarse(box, plan);
    if (plan.shortage && request.may_be_double()) plan.precision = bmesh::Precision::Double;
  }
  plan.effort = request.effort;
  plan.effort = bmesh::possible_effort(original.solid, search_options(request, plan));
  plan.work = bmesh::work_allowed(original.solid, search_options(request, plan));
  return plan;
}

}  // namespace kaboum::certify
