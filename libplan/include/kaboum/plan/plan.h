#pragma once

#include <kaboum/plan/model.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kaboum::plan {

/// `Question::choice` of the calls of external functions, by the calls' texts,
/// "fetch(robot1, o1, home)"; of those that are not there, 0.
using Choices = std::map<std::string, unsigned>;

/// A ground action of a plan.
struct PlanAction {
  Index schema = 0;  ///< of Model::actions
  std::vector<Index> arguments;
};

/// A contingent plan: an acyclic graph whose equal sub-plans are shared (docs/planning/plans.md).
/// Execution starts at `root`, performs the node's action, looks at what was sensed if the node
/// branches, and goes on. kNone as a successor is the end: the goal holds.
struct Plan {
  struct Branch {
    bool function = false;  ///< a term of Kv; else an atom of Kw
    Index symbol = 0;
    std::vector<Index> arguments;
    struct Case {
      Index value = 0;  ///< atom: 1 true, 0 false; term: the object
      Index next = kNone;
    };
    std::vector<Case> cases;
  };
  /// Value returned by an external function that the action's precondition names by `let`.
  struct Call {
    Index external = 0;
    std::vector<std::string> arguments;
    std::string value;
    std::string payload;
    [[nodiscard]] bool operator==(const Call&) const = default;
  };
  struct Node {
    bool acts = false;
    bool branches = false;
    PlanAction action;
    std::vector<Call> calls;  ///< one for each `let`, in their order
    Branch branch;
    Index next = kNone;  ///< when it does not branch
  };
  std::vector<Node> nodes;
  Index root = kNone;
  std::uint64_t seed = 0;  ///< of its calls
  unsigned attempts = 0;   ///< the most that one of them took; 0: no function reads the state
  Choices choices;         ///< of its calls
  /// Who answered external functions without certifying it, in words; empty: nobody.
  std::string not_certified = {};

  [[nodiscard]] bool operator==(const Plan& other) const;
};

/// Size of a plan; the tree's figures are saturated at 10^18.
struct PlanSize {
  std::uint64_t nodes = 0;
  std::uint64_t branches = 0;
  std::uint64_t tree_actions = 0;  ///< when nothing is shared
  std::uint64_t leaves = 0;
  std::uint64_t longest = 0;  ///< actions on the longest path
  std::int64_t cost = 0;      ///< of the most expensive path
};

/// @throws Error{InvalidInput} for a cycle, a missing node, or two cases of a branch for one value.
PlanSize measure(const Model& model, const Plan& plan);

/// Called now and then by what may take long; what it throws ends the work.
using PlanProgress = std::function<void()>;

/// Nodes that a tree has at the most, where nothing else is asked for.
inline constexpr std::size_t kMostTreeNodes = 1'000'000;

/// The same plan without sharing. @throws Error{LimitReached} beyond `limit` nodes.
Plan expand_tree(const Plan& plan, std::size_t limit = kMostTreeNodes,
                 const PlanProgress& progress = {});

/// JSON, as docs/planning/plans.md describes it.
std::string write_plan(const Model& model, const Plan& plan);
/// @throws Error{InvalidInput} on anything but a well-formed plan of this model's domain and names.
Plan read_plan(const Model& model, const std::string& json, const std::string& file_name);

/// A plan's graph in words: what drawings show of it.
struct PlanGraph {
  struct Edge {
    Index to = kNone;  ///< kNone: the goal
    std::string label = {};
  };
  struct Node {
    std::string text;
    std::vector<Edge> next;
    bool branches = false;
  };
  std::vector<Node> nodes;
  Index root = kNone;
};

/// @throws Error as measure
PlanGraph plan_graph(const Model& model, const Plan& plan);

/// An indented text, Graphviz DOT, or a drawing.
/// @throws Error{LimitReached} if the text's indentation would take more than 256 MiB.
std::string plan_text(const Model& model, const Plan& plan, const PlanProgress& progress = {});
std::string plan_dot(const Model& model, const Plan& plan, const PlanProgress& progress = {});
std::string plan_svg(const Model& model, const Plan& plan, const PlanProgress& progress = {});
/// The same drawing. @throws Error{InvalidInput} for a cycle, a missing node, or one without a
/// next one
std::string plan_svg(const PlanGraph& graph, const PlanProgress& progress = {});

/// "name(a, b)"; of a case "p(a)" or "!p(a)" or "f(a) = c".
std::string action_text(const Model& model, const PlanAction& step);
std::string case_text(const Model& model, const Plan::Branch& branch, Index value);

}  // namespace kaboum::plan
