// What all parts of one search for bodies share.

#include "search_state.h"

#include <kaboum/base/error.h>

#include <utility>

#include "options.h"

namespace kaboum::bcd {

SearchState::SearchState(const Mesh& closed, const CoverOptions& options, double work, Tuning how)
    : options_(options),
      tuning_(std::move(how)),
      solid_(closed, tuning_.grid, finest_epsilon(options).value_or(0), false, work),
      tree_(solid_, tuning_.search, options.safety) {
  if (!options.regions.empty()) {
    ensure(options.epsilon.has_value(), "regions without an epsilon");
    solid_.weigh(options.regions, *options.epsilon);
    tree_.reestimate();
  }
}

SearchState::SearchState(const SearchState& same, const CoverOptions& options, double work)
    : options_(options),
      tuning_(same.tuning_),
      solid_(same.solid_, work),
      tree_(same.tree_, solid_) {}

bool SearchState::spent(double share) {
  const Work& work = solid_.work();
  const bool only_improves = improving_ && share <= kImproving;
  const auto done = static_cast<double>(work.done());
  const bool out =
      (only_improves && options_.improve_work && done >= 1e9 * *options_.improve_work) ||
      work.spent(share);
  out_of_work_ = out_of_work_ || out;
  return out || (only_improves && done >= patient_until_);
}

void SearchState::begin_improving() {
  improving_ = true;
  improved();
}

void SearchState::improved() {
  patient_until_ = (1 + tuning_.patience) * static_cast<double>(solid_.work().done());
}

void SearchState::report(const char* stage, double fraction) const {
  if (options_.progress) options_.progress({stage, fraction});
}

void SearchState::begin_cutting() {
  if (std::exchange(begun_, true)) return;
  report("looking for pits", 0);
  solid_.find_witnesses();
  tree_.reestimate();
}

bool SearchState::add_witness(const SolidField::Witness& witness, std::span<const Vec3> hull) {
  if (!solid_.add_witness(witness, hull)) return false;
  memo_ = {};
  tree_.reestimate(witness);
  return true;
}

std::vector<Body> SearchState::leaf_bodies(std::size_t count) const {
  std::vector<Body> out;
  for (const int leaf : tree_.leaves(count)) out.push_back(body_of(tree_, leaf));
  return out;
}

std::vector<Body> SearchState::merged(std::vector<Body> bodies, std::size_t target, double epsilon,
                                      double volume_weight) {
  return merge(std::move(bodies), solid_, target, epsilon, volume_weight, memo_);
}

}  // namespace kaboum::bcd
