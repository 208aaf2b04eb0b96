#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_set>
#include <vector>

#include "collapse_evaluator.h"

namespace kaboum::bmesh {

/// An edge, whichever end is named first.
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Which edges are contracted, and when, besides what the quadrics say. All calls are about the
/// candidate at hand.
class CollapsePolicy {
 public:
  CollapsePolicy() = default;
  CollapsePolicy(const CollapsePolicy&) = delete;
  CollapsePolicy& operator=(const CollapsePolicy&) = delete;
  virtual ~CollapsePolicy() = default;

  [[nodiscard]] virtual CollapseEvaluator::Purpose purpose() const = 0;
  /// Whether an edge that is refused enters the queue again when a contraction has changed its
  /// star.
  [[nodiscard]] virtual bool tries_again() const = 0;
  /// Whether the edge is worth looking at: asked before it is the candidate.
  [[nodiscard]] virtual bool is_hopeful(const BucketQueue::Entry& e) = 0;
  /// To be told that there is no valid place for its vertex.
  virtual void has_no_place(const BucketQueue::Entry& e) = 0;
  /// Finds out what it costs. @return whether it stays a candidate now.
  virtual bool assess(BucketQueue::Entry& e) = 0;
  /// The last tests, when it is due. @return whether it may be applied.
  virtual bool admit(BucketQueue::Entry& e) = 0;
  /// Whether further edges are looked at.
  [[nodiscard]] virtual bool goes_on() = 0;
  /// To be told just before the candidate is applied, and just after.
  virtual void before() = 0;
  virtual void after() = 0;
};

/// Contracts the edges of a mesh in the order of what they cost. Source: [gaschler2016] Alg. 2.
///
/// The queue is lazy: an edge enters with what it is expected to cost; the place of its vertex is
/// sought when it is popped, for the planes of that moment.
class Contraction {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  /// In WorkingMesh::border: the vertex has triangles elsewhere and is not touched at all.
  static constexpr char kLocked = 2;

  /// @param steps  receives the steps, when not null.
  Contraction(const Context& context, WorkingMesh mesh, std::vector<Quadric> quadric,
              ReferenceSolid* solid, std::vector<Step>* steps);
  Contraction(const Contraction&) = delete;
  Contraction& operator=(const Contraction&) = delete;
  ~Contraction() = default;

  /// Contracts until `target` vertices are left or the next costs more than `limit`.
  /// @param policy  asked besides, if not null.
  /// @return whether the last pass over all edges contracted any.
  bool pass(std::size_t target, double limit = kNoLimit, CollapsePolicy* policy = nullptr);

  /// Applies the candidate, and tells the policy, if not null. @pre it is valid and admitted
  void apply(CollapsePolicy* policy = nullptr);

  /// To be called after somebody else has contracted the edge (a, b).
  void contracted(std::uint32_t a, std::uint32_t b);

  /// Keeps an entry for when its cost is due. @return false
  bool postpone(const BucketQueue::Entry& e) {
    const double cost = evaluator_.candidate().cost;
    postponed_ = true;
    if (!(cost > limit_)) queue_.push(cost, e);
    return false;
  }

  [[nodiscard]] Quadric merged(std::uint32_t a, std::uint32_t b) const {
    return context_.cost.merged(quadric_[a], quadric_[b], m_.position[a], m_.position[b]);
  }
  [[nodiscard]] CollapseEvaluator::Validity evaluate(std::uint32_t a, std::uint32_t b,
                                                     CollapseEvaluator::Purpose purpose) {
    return evaluator_.evaluate(a, b, merged(a, b), purpose, queue_);
  }

  [[nodiscard]] WorkingMesh& mesh() { return m_; }
  [[nodiscard]] std::vector<Quadric>& quadrics() { return quadric_; }
  [[nodiscard]] CollapseEvaluator& evaluator() { return evaluator_; }
  [[nodiscard]] const BucketQueue& queue() const { return queue_; }
  [[nodiscard]] std::size_t vertices() const { return vertices_; }
  [[nodiscard]] DecimateStatistics& statistics() { return statistics_; }

 private:
  void push_all();
  void push_edge(std::uint32_t a, std::uint32_t b);
  /// Whether the entry's edge was contracted; if not, it waits in the queue, or is refused.
  bool contract(BucketQueue::Entry& e, CollapsePolicy* policy);
  void refuse(std::uint32_t a, std::uint32_t b);
  void try_again_around(std::uint32_t v);
  // Stamps only rise, so a sum of two is unchanged only if both are.
  [[nodiscard]] bool stale(const BucketQueue::Entry& e) const {
    return stamp_[e.a] + stamp_[e.b] != e.stamps;
  }

  const Context& context_;
  WorkingMesh m_;
  std::vector<Quadric> quadric_;
  std::vector<std::uint32_t> stamp_;  // of a vertex: raised when it is moved or vanishes
  std::vector<Step>* steps_;
  BucketQueue queue_;
  double limit_ = kNoLimit;                    // of what enters the queue
  bool postponed_ = false;                     // the edge popped last waits in the queue
  std::unordered_set<std::uint64_t> refused_;  // edges that wait until their star has changed
  std::vector<char> has_refused_;              // of a vertex: some of its edges may be refused
  std::vector<std::uint32_t> around_;
  std::size_t vertices_;
  DecimateStatistics statistics_;
  CollapseEvaluator evaluator_;
};

}  // namespace kaboum::bmesh
