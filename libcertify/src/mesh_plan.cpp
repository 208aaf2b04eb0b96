// What a request for a bounding mesh comes to: lengths in the mesh's unit, float32 or double,
// effort and work.

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/verify/loose_triangles.h>

#include <algorithm>
#include <cmath>

#include "mesh_certifier.h"

namespace kaboum::certify {
namespace {

/// No closed mesh has fewer vertices.
constexpr std::size_t kLeastVertices = 4;

/// Whether three points lie on no line: decided exactly, in three projections.
bool has_area(const geom::Vec3& a, const geom::Vec3& b, const geom::Vec3& c) {
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3;
    if (geom::orient2d(a[x], a[y], b[x], b[y], c[x], c[y]) != geom::Sign::Zero) return true;
  }
  return false;
}

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

}  // namespace

void require_area(const geom::Mesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles)
    if (has_area(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) return;
  throw Error(ErrorCode::InvalidInput,
              "no triangle has an area: they are segments, and enclose nothing; have a wrap give "
              "them a thickness («prepare=wrap»), or export the mesh with more digits");
}

// Closed by its own fill, a flat sheet would be certified to lie in a solid that is nothing.
void require_extent(const geom::Prepared& original) {
  if (original.solid.filled_triangles() > 0 && !geom::convex_hull(original.solid.mesh().vertices))
    throw Error(ErrorCode::InvalidInput,
                "all triangles lie in one plane and enclose nothing; have a wrap give the sheet a "
                "thickness («prepare=wrap»), or have bcd-decompose cover it");
  require_area(original.solid.mesh());
}

geom::Prepared prepare_mesh(const geom::Mesh& mesh, const geom::PrepareOptions& options) {
  geom::Prepared prepared = geom::prepare(mesh, options, verify::find_loose_triangles);
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
    plan.shortage = too_coarse(box, plan.epsilon);
    if (plan.shortage && request.may_be_double()) plan.precision = bmesh::Precision::Double;
  }
  plan.effort = request.effort;
  plan.effort = bmesh::possible_effort(original.solid, search_options(request, plan));
  plan.work = bmesh::work_allowed(original.solid, search_options(request, plan));
  return plan;
}

}  // namespace kaboum::certify
