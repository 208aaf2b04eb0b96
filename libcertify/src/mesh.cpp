// Bounding meshes, from the request to what is certified: plan, decimate, certify.

#include <kaboum/base/error.h>
#include <kaboum/certify/mesh.h>

#include <algorithm>

#include "mesh_certifier.h"
#include "mesh_options.h"

namespace kaboum::certify {
namespace {

/// Candidates: nothing is claimed of them yet.
std::vector<bmesh::DecimateResult> decimate(const geom::Prepared& original,
                                            const MeshRequest& request, const MeshPlan& plan,
                                            const MeshHooks& hooks) {
  bmesh::DecimateOptions options = options_of(request, plan);
  options.record_steps = request.record_steps;
  if (hooks.progress)
    options.progress = [&, start = original.solid.mesh().vertices.size()](std::size_t vertices) {
      std::string text =
          std::to_string(vertices) + " of " + std::to_string(start) + " vertices left";
      if (!plan.vertices.empty()) text += ", " + std::to_string(plan.vertices.back()) + " wished";
      hooks.progress(text);
    };
  if (plan.vertices.size() > 1)
    return bmesh::decimate_series(original.solid, options, plan.vertices);
  if (!plan.vertices.empty()) options.vertices = plan.vertices.front();
  std::vector<bmesh::DecimateResult> one;
  one.push_back(bmesh::decimate(original.solid, options));
  return one;
}

}  // namespace

MeshSeries certify_meshes(const geom::Prepared& original, const MeshRequest& request,
                          const MeshHooks& hooks) {
  require_extent(original);
  MeshSeries series;
  series.plan = plan_mesh(original, request);
  series.shortage = series.plan.shortage;
  if (series.shortage && !request.may_be_double()) return series;
  std::vector<bmesh::DecimateResult> candidates = decimate(original, request, series.plan, hooks);
  for (const bmesh::DecimateResult& candidate : candidates)
    series.steps.insert(series.steps.end(), candidate.steps.begin(), candidate.steps.end());
  if (hooks.found) hooks.found();
  std::size_t without_place = 0;
  for (const bmesh::DecimateResult& candidate : candidates)
    without_place = std::max(without_place, candidate.unrepresentable);
  if (without_place > 0) {
    series.shortage.emplace().vertices = without_place;
    if (!request.may_be_double()) return series;
  }
  series.meshes =
      MeshCertifier(original, request, series.plan, hooks).certify(std::move(candidates));
  return series;
}

std::optional<CertifiedMesh> certify_mesh(const geom::Prepared& original,
                                          const MeshRequest& request, const MeshHooks& hooks) {
  if (request.vertices.size() > 1)
    throw Error(ErrorCode::InvalidArgument, "one result has one number of vertices");
  MeshSeries series = certify_meshes(original, request, hooks);
  if (series.meshes.empty()) return std::nullopt;
  return std::move(series.meshes.front());
}

}  // namespace kaboum::certify
