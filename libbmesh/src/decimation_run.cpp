// What is done before a decimation proper, and vertices' numbers from one part to the next.

#include "decimation_run.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <utility>

namespace kaboum::bmesh {

DecimationRun::DecimationRun(const geom::Prepared& input, const DecimateOptions& options,
                             Work& work, std::optional<RisingBound> rising, bool sketch)
    : input_(input), options_(options), work_(work), rising_(rising), sketch_(sketch) {
  options_.effort = effective_effort(input, options);
  if (options.keep_convex) return;
  std::vector<std::uint32_t> flat = flat_vertices(input);
  if (!flat.empty()) flattener_.emplace(input, std::move(flat), options.steps);
}

DecimateResult DecimationRun::to(std::optional<std::size_t> target) {
  if (flattener_) flattener_->run(target.value_or(0));
  if (target && !decimator_ && is_reached(*target)) {
    DecimateResult result;
    result.mesh = flattener_ ? flattener_->mesh() : input_.mesh;
    result.stop = Stop::VertexTarget;
    return finished(std::move(result));
  }
  if (!decimator_) start(target);
  DecimateResult result = decimator_->run(target);
  append_steps();
  return finished(std::move(result));
}

double DecimationRun::reached_alone() const { return decimator_ ? decimator_->reached_alone() : 0; }

void DecimationRun::nest_in(const geom::Mesh& level) {
  if (decimator_) decimator_->nest_in(level);  // what is flat nests anyway
}

/// Whether nothing is left to do but to flatten.
bool DecimationRun::is_reached(std::size_t target) const {
  const std::size_t n = flattener_ ? flattener_->vertices() : input_.mesh.vertices.size();
  if (n > target) return false;
  if (options_.precision == Precision::Double) return true;
  if (flattener_) return flattener_->is_float32();
  return std::all_of(input_.mesh.vertices.begin(), input_.mesh.vertices.end(),
                     [](const Vec3& p) { return geom::is_float32(p); });
}

void DecimationRun::start(std::optional<std::size_t> target) {
  if (flattener_) flatten();
  const geom::Prepared& input = flat_.mesh.triangles.empty() ? input_ : flat_;
  inner_options_ = options_;
  inner_options_.steps = options_.steps != nullptr ? &inner_steps_ : nullptr;
  context_.emplace(input, inner_options_, &work_);
  if (options_.direction == Direction::Inner && input.closed && !options_.keep_convex)
    solid_.emplace(input.mesh, nullptr, &work_);
  PartialMesh mesh(input.mesh, input.border, context_->cost.initial(input.mesh));
  if (target && !options_.epsilon && !rising_ && !options_.keep_convex) {
    contract_in_regions(*context_, mesh, measured_from(options_, *target),
                        solid_ ? &*solid_ : nullptr, inner_options_.steps, before_);
    append_steps();
  }
  number_ = mesh.vertex;
  if (!source_.empty())
    for (std::uint32_t& v : number_) v = source_[v];
  decimator_.emplace(*context_, input.mesh, std::move(mesh), solid_, inner_options_.steps, rising_,
                     sketch_);
}

void DecimationRun::flatten() {
  before_.contractions = flattener_->contractions();
  before_.flips = flattener_->flips();
  if (before_.contractions + before_.flips > 0) {
    flat_.mesh = flattener_->mesh(&source_);
    flat_.closed = input_.closed;
    for (const std::uint32_t v : source_) flat_.border.push_back(input_.border[v]);
    number_ = source_;
  }
  flattener_.reset();
}

/// Hands over the steps so far, numbered as in the input.
void DecimationRun::append_steps() {
  if (options_.steps == nullptr) return;
  if (!number_.empty())
    for (Step& s : inner_steps_) {
      for (std::uint32_t* v : {&s.kept, &s.gone}) *v = number_[*v];
      if (s.kind == Step::Kind::Flip)
        for (std::uint32_t* v : {&s.left, &s.right}) *v = number_[*v];
    }
  options_.steps->insert(options_.steps->end(), inner_steps_.begin(), inner_steps_.end());
  inner_steps_.clear();
}

DecimateResult DecimationRun::finished(DecimateResult result) const {
  DecimateStatistics& s = result.statistics;
  if (flattener_) {
    s.contractions += flattener_->contractions();
    s.flips += flattener_->flips();
  }
  add(s, before_);
  s.vertices_in = input_.mesh.vertices.size();
  s.vertices_out = result.mesh.vertices.size();
  if (options_.steps != nullptr) result.steps = options_.steps->size();
  if (options_.keep_convex)
    ensure(geom::is_convex(geom::weld(result.mesh)), "a contraction lost convexity");
  return result;
}

}  // namespace kaboum::bmesh
