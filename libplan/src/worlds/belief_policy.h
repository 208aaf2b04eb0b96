#pragma once

#include <kaboum/plan/plan.h>

#include <map>
#include <unordered_map>
#include <vector>

#include "worlds/belief_space.h"

namespace kaboum::plan::worlds {

/// Where an entry of a policy can be used: the common part agrees in `common`, and of each listed
/// component every world is among the good ones. docs/planning/knowledge-states.md, "What a plan
/// depends on", has the proof.
struct Requirement {
  struct Component {
    Index component = 0;
    Index exactly = kNone;   ///< the set must be this one
    std::vector<Word> good;  ///< else a bit for each world
    [[nodiscard]] bool admits(Index world) const {
      return world / 64 < good.size() && ((good[world / 64] >> (world % 64)) & 1U) != 0;
    }
  };
  std::vector<Word> common;           ///< bits that matter
  std::vector<Component> components;  ///< ascending; of the others nothing is required
};

/// What to do in beliefs, entry by entry. An entry is good for every belief that meets what it, and
/// all after it, requires: beliefs that differ otherwise share it.
class BeliefPolicy {
 public:
  BeliefPolicy(BeliefSpace& space, const Model& model);

  /// One outcome of an entry's operator: what is sensed, and the entry to go on with.
  struct Case {
    std::vector<std::pair<Index, Index>> sensed;
    Index next = kNone;
  };

  /// An entry for this belief that is there already; kNone: there is none.
  [[nodiscard]] Index find(const Word* belief);
  /// @pre each case's entry is good for the belief that it leads to.
  Index add(const Word* belief, Index op, std::vector<Case> cases);

  /// From the start, which may branch at once.
  [[nodiscard]] Plan plan(const std::vector<Case>& start) const;
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kMostPatterns = 400;
  static constexpr std::size_t kMostAlike = 64;          ///< entries with one key
  static constexpr Index kMostWorlds = Index{1} << 17U;  ///< that good ones are looked for among

  struct Entry {
    Index op = kNone;  ///< kNone: the goal holds
    std::vector<Case> cases;
    Requirement required;
  };
  /// What holds in a belief and is enough for a condition: values of hidden variables, and
  /// components that must stay as they are.
  struct Reasons {
    std::vector<const Condition*> literals;
    std::vector<Index> exact;
  };

  void explain(const Condition& c, const Word* belief, Requirement& out, Reasons& reasons) const;
  void read(const Condition& c, Requirement& common, std::vector<Index>& components) const;
  [[nodiscard]] std::vector<Index> involved(const Entry& e, const Reasons& reasons) const;
  [[nodiscard]] Requirement::Component good_worlds(const Entry& e, const Word* belief,
                                                   const Reasons& reasons, Index component);
  [[nodiscard]] bool is_good(const Entry& e, const Word* belief, const Reasons& reasons,
                             Index component, Index world);
  Index end(const Word* belief);
  Index enter(Entry e, const Word* belief, const Reasons& reasons);
  [[nodiscard]] bool admits(const Requirement& r, const Word* belief) const;
  [[nodiscard]] std::uint64_t key(const std::vector<Word>& mask, const Word* belief) const;
  void learn(Index entry, const Word* belief);
  Index branch(const std::vector<Case>& cases, std::size_t from, std::size_t to, std::size_t depth,
               const std::vector<Index>& nodes, Plan& plan) const;
  void branch_at(const std::vector<Case>& cases, std::size_t from, std::size_t to,
                 std::size_t depth, const std::vector<Index>& nodes, Plan& plan, Index node) const;

  BeliefSpace& space_;
  const Model& model_;
  std::vector<Entry> entries_;
  std::vector<std::vector<Word>> operator_writes_;  ///< common bits that it always sets
  struct Pattern {
    std::vector<Word> mask;
    std::unordered_map<std::uint64_t, std::vector<std::pair<std::vector<Word>, Index>>> entries;
  };
  std::map<std::vector<Word>, std::size_t> pattern_number_;
  std::vector<Pattern> patterns_;
  std::size_t bytes_ = 0;
};

}  // namespace kaboum::plan::worlds
