// What the parts of a decimation share.

#include "decimation_state.h"

#include <utility>

namespace kaboum::bmesh {

DecimationState::DecimationState(const Context& run, const geom::Mesh& made_of, PartialMesh start,
                                 std::optional<ReferenceSolid>& of_bound, std::vector<Step>* record,
                                 const std::optional<RisingBound>& rising)
    : context(run),
      options(run.options),
      original(made_of),
      bound(&made_of),
      reference(of_bound),
      steps(record),
      epsilon(rising ? rising->from : run.options.epsilon),
      most_epsilon(rising ? rising->to : 0),
      alone(rising ? rising->alone : 0),
      in_clusters(epsilon && options.cost == Cost::Distance && options.effort != Effort::Fast),
      contraction(run,
                  WorkingMesh(std::move(start.position), std::move(start.border),
                              std::move(start.triangles)),
                  std::move(start.quadric), of_bound ? &*of_bound : nullptr, record) {
  if (epsilon) carried.emplace(original, *epsilon, context.work);
}

bool DecimationState::spent(double share) {
  if (context.work == nullptr || !context.work->spent(share)) return false;
  ended_early = true;
  return true;
}

void DecimationState::start_measuring() {
  sampled.emplace(
      original, options.cost == Cost::Mean ? 2 : 4, in_clusters ? kSpacing * *epsilon : 0,
      most_epsilon > 0 ? kSamplesRising : kSamples, context.work,
      carried ? carried->closest()
              : std::make_shared<const ClosestTriangle>(original, options.effort != Effort::Fast));
  sampled->assign(mesh().position, mesh().mesh);
  measuring = true;
}

void DecimationState::start_optimising() {
  if (context.constrained && !reference)
    reference.emplace(*bound, bound == &original ? sampled->original().hierarchy() : nullptr,
                      context.work);
  optimiser.emplace(mesh(), *sampled, context.constrained ? solid() : nullptr, *bound,
                    certificate(), options, contraction.statistics(), steps, in_clusters,
                    context.work);
}

}  // namespace kaboum::bmesh
