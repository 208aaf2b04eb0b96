// What is done before a decimation proper, and vertices' numbers from one part to the next.

#include "decimation_run.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <utility>

namespace kaboum::bmesh {

DecimationRun::DecimationRun(const geom::SolidMesh& input, const DecimateOptions& options,
                             Work& work, std::optional<RisingBound> rising, bool sketch)
    : input_(input), options_(options), work_(work), rising_(rising), sketch_(sketch) {
  if (options.keep_convex) return;
  std::vector<std::uint32_t> flat = flat_vertices(input);
  if (!flat.empty()) flattener_.emplace(input, std::move(flat), recorded(steps_));
}

std::vector<Step>* DecimationRun::recorded(std::vector<Step>& steps) const {
  return options_.record_steps ? &steps : nullptr;
}

DecimateResult DecimationRun::to(std::optional<std::size_t> target) {
  if (flattener_) flattener_->run(target.value_or(0));
  if (target && !decimator_ && is_reached(*target)) {
    DecimateResult result;
    result.mesh = flattener_ ? flattener_->mesh() : input_.mesh();
    result.stop = Stop::VertexTarget;
    return finished(std::move(result));
  }
  if (!decimator_) start(target);
  DecimateResult result = decimator_->run(target);
  append_steps();
  return finished(std::move(result));
}

double DecimationRun::reached_alone() const { return decimator_ ? decimator_->reached_alone() : 0; }

double DecimationRun::bound() const { return decimator_ ? decimator_->bound() : 0; }

void DecimationRun::nest_in(const geom::Mesh& level) {
  if (decimator_) decimator_->nest_in(level);  // what is flat nests anyway
}

/// Whether nothing is left to do but to flatten.
bool DecimationRun::is_reached(std::size_t target) const {
  const std::size_t n = flattener_ ? flattener_->vertices() : input_.mesh().vertices.size();
  if (n > target) return false;
  if (options_.precision == Precision::Double) return true;
  if (flattener_) return flattener_->is_float32();
  return std::all_of(input_.mesh().vertices.begin(), input_.mesh().vertices.end(),
                     [](const Vec3& p) { return geom::is_float32(p); });
}

void DecimationRun::start(std::optional<std::size_t> target) {
  if (flattener_) flatten();
  const bool flattened = !flat_.empty();
  const geom::Mesh& input = flattened ? flat_ : input_.mesh();
  std::vector<Step>* const steps = recorded(inner_steps_);
  context_.emplace(input, input_.closed(), options_, &work_);
  if (options_.direction == Direction::Inner && input_.closed() && !options_.keep_convex)
    solid_.emplace(input, nullptr, &work_);
  PartialMesh mesh(input, flattened ? flat_border_ : input_.border(),
                   context_->cost.initial(input));
  if (target && !options_.epsilon && !rising_ && !options_.keep_convex) {
    contract_in_regions(*context_, mesh, measured_from(options_, *target),
                        solid_ ? &*solid_ : nullptr, steps, before_);
    append_steps();
  }
  number_ = mesh.vertex;
  if (!source_.empty())
    for (std::uint32_t& v : number_) v = source_[v];
  decimator_.emplace(*context_, input, std::move(mesh), solid_, steps, rising_, sketch_);
}

void DecimationRun::flatten() {
  before_.contractions = flattener_->contractions();
  before_.flips = flattener_->flips();
  if (before_.contractions + before_.flips > 0) {
    flat_ = flattener_->mesh(&source_);
    for (const std::uint32_t v : source_) flat_border_.push_back(input_.border()[v]);
    number_ = source_;
  }
  flattener_.reset();
}

/// Hands over the steps so far, numbered as in the input.
void DecimationRun::append_steps() {
  if (!options_.record_steps) return;
  if (!number_.empty())
    for (Step& s : inner_steps_) {
      for (std::uint32_t* v : {&s.kept, &s.gone}) *v = number_[*v];
      if (s.kind == Step::Kind::Flip)
        for (std::uint32_t* v : {&s.left, &s.right}) *v = number_[*v];
    }
  steps_.insert(steps_.end(), inner_steps_.begin(), inner_steps_.end());
  inner_steps_.clear();
}

DecimateResult DecimationRun::finished(DecimateResult result) {
  DecimateStatistics& s = result.statistics;
  if (flattener_) {
    s.contractions += flattener_->contractions();
    s.flips += flattener_->flips();
  }
  add(s, before_);
  s.vertices_in = input_.mesh().vertices.size();
  s.vertices_out = result.mesh.vertices.size();
  result.steps = std::exchange(steps_, {});
  if (options_.keep_convex)
    ensure(geom::is_convex(geom::weld(result.mesh)), "a contraction lost convexity");
  return result;
}

}  // namespace kaboum::bmesh
