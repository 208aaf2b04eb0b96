#pragma once

#include <unordered_map>

#include "decimation_state.h"

namespace kaboum::bmesh {

/// What contractions have to pass besides the tests of the evaluator: measured distances as costs,
/// positions that the original bounds rather than the present mesh, the carried error bound.
class MeasuredPolicy final : public CollapsePolicy {
 public:
  explicit MeasuredPolicy(DecimationState& state) : state_(state) {}

  /// To be called when measuring, and optimisation, have begun anew.
  void begin_measuring();
  void forget_refusals() { refusals_.clear(); }

  /// The dearer tests of a candidate that is about to be applied.
  [[nodiscard]] bool admissible();

  /// Moves contracted vertices back towards the original that have not been yet.
  void pull_back_recent();

  // ---- CollapsePolicy

  [[nodiscard]] CollapseEvaluator::Purpose purpose() const override;
  [[nodiscard]] bool tries_again() const override { return state_.measuring; }
  bool goes_on() override;
  bool is_hopeful(const BucketQueue::Entry& e) override;
  void has_no_place(const BucketQueue::Entry& e) override;
  bool assess(BucketQueue::Entry& e) override;
  bool admit(BucketQueue::Entry& e) override;
  void before() override;
  void after() override;

 private:
  struct Refusal {
    std::uint32_t version = 0;  // of both ends
    double takes = 0;           // the error bound that it takes, at least
    bool by_epsilon = false;    // that alone stands against it
  };

  [[nodiscard]] CollapseEvaluator& evaluator() { return state_.contraction.evaluator(); }
  [[nodiscard]] CollapseEvaluator::Candidate& candidate() { return evaluator().candidate(); }
  [[nodiscard]] DecimateStatistics& statistics() { return state_.contraction.statistics(); }
  [[nodiscard]] Quadric merged();
  void refuse(std::uint32_t a, std::uint32_t b, double takes, bool by_epsilon);
  bool reject(std::uint64_t& counter);
  bool reject_by_epsilon(double takes);
  void star_changed(std::uint32_t v);
  void describe_change() { evaluator().describe(removed_, added_); }
  void describe_points();
  bool measure(BucketQueue::Entry& e);
  bool measure_densely(BucketQueue::Entry& e);
  [[nodiscard]] bool spikes();
  bool place_against_original();
  bool certify(BucketQueue::Entry& e);

  DecimationState& state_;
  std::unordered_map<std::uint64_t, Refusal> refusals_;  // of contractions, by edge
  std::vector<std::uint32_t> recent_;  // contracted vertices that have not been pulled back yet
  std::vector<std::uint32_t> around_;  // of a vertex: raised when anything in its star changes
  std::vector<std::uint32_t> hint_;    // per vertex: where the original is near
  // Of the candidate at hand.
  std::vector<SampledError::Point> points_;
  std::vector<std::uint32_t> removed_;
  std::vector<NewTriangle> added_;
};

}  // namespace kaboum::bmesh
