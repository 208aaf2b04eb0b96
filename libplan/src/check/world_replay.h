#pragma once

#include <kaboum/plan/check.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "check/live_facts.h"
#include "check/world_rules.h"

namespace kaboum::plan {

/// Replays a plan on sets of possible worlds, as they are: for models of which the databases of
/// knowledge keep less than follows. The validator's own; the planner's sets share nothing with it.
class WorldReplay {
 public:
  WorldReplay(const Model& model, const Plan& plan, std::uint64_t limit,
              const CheckProgress& progress);

  /// Whether the model is of the kind: it has neither external functions nor rules.
  static bool takes(const Model& model) { return model.externals.empty() && model.rules.empty(); }

  /// nullopt: there are too many worlds to begin with.
  std::optional<CheckResult> run();

 private:
  static constexpr std::size_t kNoParent = ~std::size_t{0};
  struct Visit {
    Index node;
    const WorldRules::Belief* belief;
    std::size_t parent;
    std::string label;
  };

  [[nodiscard]] std::string path(std::size_t v) const;
  void violate(std::size_t v, const std::string& what);
  void visit(Index node, const WorldRules::Belief& b, std::size_t parent, std::string label);
  void replay(std::size_t v);
  void follow(std::size_t v, const Plan::Branch& branch, const WorldRules::Belief& b,
              const std::string& label);

  const Model& model_;
  const Plan& plan_;
  std::uint64_t limit_;
  const CheckProgress& progress_;
  QueryEvaluator evaluator_;
  LiveFacts live_;
  WorldRules rules_;
  std::set<std::pair<Index, WorldRules::Belief>> seen_;
  std::vector<Visit> visits_;
  std::map<Index, std::size_t> contradicted_;
  std::set<Index> passed_;
  CheckResult result_;
};

}  // namespace kaboum::plan
