// Bounding meshes, from the request to what is certified: plan, decimate, certify.

#include <kaboum/base/error.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/geom/preparation_doubt.h>

#include <algorithm>

#include "given_solid.h"
#include "mesh_certifier.h"

namespace kaboum::certify {
namespace {

/// Candidates: nothing is claimed of them yet.
std::vector<bmesh::DecimateResult> decimate(const geom::Prepared& original,
                                            const MeshRequest& request, const MeshPlan& plan,
                                            const MeshHooks& hooks) {
  bmesh::DecimateOptions options = search_options(request, plan);
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

/// @param wrapped  the input, where the original is its wrap; else null
MeshSeries certify(const geom::Prepared& original, const MeshRequest& request,
                   const MeshHooks& hooks, const geom::Mesh* wrapped) {
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
    series.shortage->keeps_border = !original.solid.closed();
    if (!request.may_be_double()) return series;
  }
  series.meshes =
      MeshCertifier(original, request, series.plan, hooks, wrapped).certify(std::move(candidates));
  return series;
}

constexpr double kShareOfWrap = 0.6;  ///< of epsilon, for a wrap

/// Bounds a wrap. What it takes of epsilon is not there for decimation.
/// @param given  triangles of what was read, with which the input begins
BoundedMesh bound_wrap(const geom::Mesh& input, std::size_t given, const MeshRequest& request,
                       const MeshPreparation& preparation, const MeshHooks& hooks) {
  if (request.direction != bmesh::Direction::Outer)
    throw Error(ErrorCode::InvalidArgument,
                "what lies in a wrap need not lie in the input: only outer results");
  if (request.record_steps)
    throw Error(ErrorCode::InvalidArgument, "steps start from the input, not from a wrap round it");
  MeshRequest rest = request;
  WrapRequest asked = preparation.wrapping;
  asked.farthest.reset();
  asked.input_triangles = given;
  std::optional<double> epsilon;
  if (request.epsilon) {
    epsilon = request.epsilon->of(geom::bounding_box(input).diagonal()) - asked.clearance;
    if (!(*epsilon > 0))
      throw Error(
          ErrorCode::InvalidInput,
          "the exact faces' deviation from the triangles leaves nothing of epsilon; allow a "
          "larger epsilon");
    asked.farthest = kShareOfWrap * *epsilon;
  }
  asked.float32 = request.numbers != MeshRequest::Numbers::Double;
  asked.may_be_double = request.may_be_double();
  asked.progress = hooks.progress;
  const CertifiedWrap wrap = certify_wrap(input, asked);
  BoundedMesh made;
  made.wrap = wrap.certificate();
  if (epsilon) rest.epsilon = Length{*epsilon - made.wrap->farthest_upper};
  made.original = prepare_mesh(wrap.artefact());
  if (hooks.prepared) hooks.prepared();
  made.series = certify(made.original, rest, hooks, &input);
  return made;
}

/// Why vertices have no place, without which there is no result; empty: they have. Sheets that are
/// closed by their own fill leave them none but their own.
std::string why_stuck(const MeshSeries& series) {
  if (!series.meshes.empty() || !series.shortage || series.shortage->vertices == 0) return {};
  return reason_of(*series.shortage);
}

bool may_help(const Error& error) {
  // InvalidArgument: epsilon makes the offset too small.
  return error.code() == ErrorCode::InvalidInput || error.code() == ErrorCode::LimitReached ||
         error.code() == ErrorCode::InvalidArgument;
}

}  // namespace

verify::Answer BoundedMesh::surface_answer() const {
  verify::Answer answer = verify::Answer::Verified;
  if (series.meshes.empty()) return verify::Answer::Undefined;
  for (const CertifiedMesh& made : series.meshes)
    answer = verify::worse(answer, made.certificate().surface_answer());
  return answer;
}

std::vector<std::string> notes_of(const BoundedMesh& made) {
  std::vector<std::string> notes;
  if (!made.wrap) {
    notes = made.original.report.notes;
    if (!made.why_not_wrapped.empty())
      notes.push_back("the input is not wrapped, although some of its triangles need that: " +
                      made.why_not_wrapped);
    return notes;
  }
  if (!made.why_wrapped.empty()) notes.push_back("the input is wrapped: " + made.why_wrapped);
  notes.push_back(in_words(*made.wrap));
  return notes;
}

MeshSeries certify_meshes(const geom::Prepared& original, const MeshRequest& request,
                          const MeshHooks& hooks) {
  return certify(original, request, hooks, nullptr);
}

namespace {

std::string undecided_of(const geom::Mesh& input, const BoundedMesh& made,
                         const MeshRequest& request, const geom::PrepareOptions& options) {
  if (request.direction != bmesh::Direction::Outer || options.keep_orientation ||
      !made.original.report.hollow || !made.original.solid.closed())
    return {};
  for (const CertifiedMesh& mesh : made.series.meshes)
    if (std::string why = undecided_solid(input, made.original, options, mesh.artefact());
        !why.empty())
      return why;
  return {};
}

}  // namespace

BoundedMesh bound_mesh(const geom::Mesh& input, const MeshRequest& request,
                       const MeshPreparation& preparation, const MeshHooks& hooks) {
  using Wrap = MeshPreparation::Wrap;
  if (preparation.wrap == Wrap::Always)
    return bound_wrap(with_other_diagonals(input, preparation.options), input.triangles.size(),
                      request, preparation, hooks);
  const bool may_wrap =
      preparation.wrap == Wrap::WhereNeeded && request.direction == bmesh::Direction::Outer &&
      preparation.options.holes == geom::Holes::Fill && !preparation.options.keep_orientation;
  BoundedMesh made;
  std::string why;
  try {
    made.original = prepare_mesh(input, preparation.options);
  } catch (const Error& error) {
    if (!may_wrap || request.record_steps || preparation.options.drop_sheets ||
        error.code() != ErrorCode::InvalidInput)
      throw;
    why = error.what();
  }
  // Where preparing had to guess what the triangles enclose, or leaves some of it out, no result
  // round its solid is what was asked for, even if every triangle is inside.
  const bool doubtful = why.empty() && may_wrap && !request.record_steps &&
                        !preparation.options.drop_sheets &&
                        !geom::doubt_about(made.original.report).empty();
  const auto certify_as_prepared = [&] {
    if (hooks.prepared) hooks.prepared();
    made.series = certify(made.original, request, hooks, nullptr);
    made.undecided = undecided_of(input, made, request, preparation.options);
  };
  if (doubtful) {
    why = geom::doubt_about(made.original.report);
  } else if (why.empty()) {
    certify_as_prepared();
    const verify::Answer answer = made.surface_answer();
    const std::string stuck = why_stuck(made.series);
    if (!may_wrap || answer == verify::Answer::Verified ||
        (answer == verify::Answer::Undefined && stuck.empty()) ||
        (!stuck.empty() && request.record_steps))
      return made;
    if (request.record_steps) {
      made.why_not_wrapped = "steps start from the input, not from a wrap round it";
      return made;
    }
    why = !stuck.empty() ? stuck
          : answer == verify::Answer::Refuted
              ? "some triangles of the input bound no solid, and would stick out of a result round "
                "the rest"
              : "whether all triangles of the input are enclosed without is not decided";
  }
  try {
    BoundedMesh wrap = bound_wrap(
        with_fillings(with_other_diagonals(input, preparation.options), made.original.solid),
        input.triangles.size(), request, preparation, hooks);
    wrap.why_wrapped = why;
    // Where float32 does not do for the wrap, the result without it stands.
    if (!wrap.series.meshes.empty() ||
        (made.series.meshes.empty() && !doubtful && !made.series.shortage))
      return wrap;
    if (doubtful) certify_as_prepared();
    made.why_not_wrapped = "float32 is too coarse for it";
  } catch (const Error& error) {
    if (!may_help(error)) throw;
    if (doubtful) certify_as_prepared();
    if (made.series.meshes.empty() && !made.series.shortage)
      throw Error(ErrorCode::InvalidInput, why + ". Nor is it wrapped: " + error.what());
    made.why_not_wrapped = error.what();
  }
  return made;
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
