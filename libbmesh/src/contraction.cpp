// Contracting edges in the order of what they cost. Source: [gaschler2016] Alg. 2.

#include "contraction.h"

namespace kaboum::bmesh {
namespace {

/// Entries at which stale ones are dropped, when there are so many without them.
std::size_t room(std::size_t entries) { return entries + entries / 2 + 1024; }

}  // namespace

Contraction::Contraction(const Context& context, WorkingMesh mesh, std::vector<Quadric> quadric,
                         ReferenceSolid* solid, std::vector<Step>* steps)
    : context_(context),
      m_(std::move(mesh)),
      quadric_(std::move(quadric)),
      stamp_(m_.position.size(), 0),
      steps_(steps),
      vertices_(m_.position.size()),
      evaluator_(context, m_, solid, statistics_) {}

void Contraction::push_edge(std::uint32_t a, std::uint32_t b) {
  if (m_.border[a] != 0 && m_.border[b] != 0) return;
  if (((m_.border[a] | m_.border[b]) & kLocked) != 0) return;
  const double key = context_.cost.expected_key(merged(a, b), m_.position[a], m_.position[b]);
  if (!(key > limit_)) queue_.push(key, {a, b, stamp_[a] + stamp_[b]});
}

void Contraction::push_all() {
  for (std::uint32_t v = 0; v < m_.position.size(); ++v) {
    if (!m_.mesh.used(v)) continue;
    for (const std::uint32_t w : evaluator_.neighbours(v))
      if (w > v) push_edge(v, w);
  }
}

bool Contraction::pass(std::size_t target, double limit, CollapsePolicy* policy) {
  bool progress = false;
  queue_.clear();
  refused_.clear();
  has_refused_.assign(m_.position.size(), 0);
  limit_ = limit;
  if (limit == kNoLimit) queue_.reserve(room(m_.mesh.size() * 3 / 2));
  push_all();
  std::size_t purge_at = room(queue_.size());
  BucketQueue::Entry e;
  const bool tries_again = policy != nullptr && policy->tries_again();
  const auto goes_on = [&] { return policy == nullptr || policy->goes_on(); };
  while (vertices_ > target && goes_on() && queue_.pop(e)) {
    if (stale(e)) continue;
    postponed_ = false;
    if (!contract(e, policy)) {
      if (tries_again && !postponed_) refuse(e.a, e.b);
      continue;
    }
    if (tries_again) try_again_around(e.a);
    progress = true;
    if (queue_.size() > purge_at) {
      queue_.purge([&](const BucketQueue::Entry& x) { return stale(x); });
      purge_at = room(queue_.size());
    }
  }
  return progress;
}

bool Contraction::contract(BucketQueue::Entry& e, CollapsePolicy* policy) {
  using Validity = CollapseEvaluator::Validity;
  if (policy != nullptr && !policy->is_hopeful(e)) return false;
  // Evaluated anew each time it is popped: what is applied holds for the planes of this moment.
  const Validity validity =
      evaluate(e.a, e.b, policy != nullptr ? policy->purpose() : CollapseEvaluator::Purpose::Due);
  if (validity == Validity::Later) return postpone(e);
  if (validity == Validity::None) {
    if (policy != nullptr) policy->has_no_place(e);
    return false;
  }
  if (policy != nullptr && !policy->assess(e)) return false;
  if (!queue_.due(evaluator_.candidate().cost)) return postpone(e);
  if (policy != nullptr ? !policy->admit(e) : !evaluator_.keeps_shape()) return false;
  apply(policy);
  return true;
}

void Contraction::refuse(std::uint32_t a, std::uint32_t b) {
  refused_.insert(edge_key(a, b));
  has_refused_[a] = has_refused_[b] = 1;
}

/// Refused edges whose star the contraction to v has changed enter the queue again.
void Contraction::try_again_around(std::uint32_t v) {
  around_ = evaluator_.neighbours(v);
  for (const std::uint32_t w : around_) {
    if (has_refused_[w] == 0) continue;
    has_refused_[w] = 0;
    for (const std::uint32_t x : evaluator_.neighbours(w))
      if (refused_.erase(edge_key(w, x)) != 0) push_edge(w, x);
  }
}

void Contraction::apply(CollapsePolicy* policy) {
  const CollapseEvaluator::Candidate& candidate = evaluator_.candidate();
  const std::uint32_t a = candidate.a, b = candidate.b;
  if (policy != nullptr) policy->before();
  if (steps_ != nullptr) steps_->push_back({a, b, candidate.position});
  quadric_[a] = merged(a, b);
  m_.mesh.contract(a, b);
  m_.position[a] = candidate.position;
  m_.border[a] = static_cast<char>(m_.border[a] | m_.border[b]);
  ++stamp_[a];
  ++stamp_[b];
  --vertices_;
  ++statistics_.contractions;
  m_.update_normals_around(a);
  if (policy != nullptr) policy->after();
  for (const std::uint32_t w : evaluator_.neighbours(a)) {
    if (!refused_.empty()) refused_.erase(edge_key(a, w));
    push_edge(a, w);
  }
}

void Contraction::contracted(std::uint32_t a, std::uint32_t b) {
  quadric_[a] = merged(a, b);
  ++stamp_[a];
  ++stamp_[b];
  --vertices_;
}

}  // namespace kaboum::bmesh
