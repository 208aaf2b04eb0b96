// Plans as graphs: equality, size, and the tree without sharing.
#include <kaboum/base/error.h>
#include <kaboum/plan/plan.h>

#include <algorithm>
#include <set>

namespace kaboum::plan {
namespace {

constexpr std::uint64_t kSaturated = 1'000'000'000'000'000'000ULL;

std::uint64_t saturating(std::uint64_t a, std::uint64_t b) { return std::min(kSaturated, a + b); }

std::vector<Index> successors(const Plan::Node& n) {
  if (!n.branches) return {n.next};
  std::vector<Index> result;
  for (const Plan::Branch::Case& c : n.branch.cases) result.push_back(c.next);
  return result;
}

/// A second case for a value would say nothing, or something else.
void require_one_case_each(const Plan::Branch& branch) {
  std::set<Index> values;
  for (const Plan::Branch::Case& c : branch.cases)
    if (!values.insert(c.value).second)
      throw Error(ErrorCode::InvalidInput,
                  "two cases of a branch of the plan are for the same value");
}

/// Nodes reachable from the root, each after its successors.
std::vector<Index> bottom_up(const Plan& plan) {
  std::vector<Index> order;
  if (plan.root == kNone) return order;
  enum : char { kNew, kOpen, kDone };
  std::vector<char> mark(plan.nodes.size(), kNew);
  struct Frame {
    Index node;
    std::size_t next;
  };
  const auto check = [&](Index n) {
    if (n >= plan.nodes.size())
      throw Error(ErrorCode::InvalidInput, "the plan names a node that is not there");
    if (mark[n] == kOpen) throw Error(ErrorCode::InvalidInput, "the plan has a cycle");
  };
  check(plan.root);
  std::vector<Frame> stack = {{plan.root, 0}};
  mark[plan.root] = kOpen;
  while (!stack.empty()) {
    const std::vector<Index> next = successors(plan.nodes[stack.back().node]);
    if (stack.back().next == next.size()) {
      mark[stack.back().node] = kDone;
      order.push_back(stack.back().node);
      stack.pop_back();
      continue;
    }
    const Index n = next[stack.back().next++];
    if (n == kNone) continue;
    check(n);
    if (mark[n] == kDone) continue;
    mark[n] = kOpen;
    stack.push_back({n, 0});
  }
  return order;
}

std::string arguments_text(const Model& model, const std::string& name,
                           const std::vector<Index>& arguments) {
  if (arguments.empty()) return name;
  std::string text = name + "(";
  for (std::size_t i = 0; i < arguments.size(); ++i)
    text += (i == 0 ? "" : ", ") + model.objects[arguments[i]].name;
  return text + ")";
}

std::int64_t cost_of(const Model& model, const PlanAction& step) {
  const Action& a = model.actions[step.schema];
  if (a.cost_function == kNone) return a.cost;
  std::vector<Index> key;
  for (const Argument& c : a.cost_arguments)
    key.push_back(c.variable ? step.arguments[c.index] : c.index);
  const auto value = model.numbers[a.cost_function].find(key);
  return value == model.numbers[a.cost_function].end() ? 0 : value->second;
}

}  // namespace

bool Plan::operator==(const Plan& other) const {
  const auto same_node = [](const Node& a, const Node& b) {
    const auto same_case = [](const Branch::Case& x, const Branch::Case& y) {
      return x.value == y.value && x.next == y.next;
    };
    return a.acts == b.acts && a.branches == b.branches && a.next == b.next &&
           a.action.schema == b.action.schema && a.action.arguments == b.action.arguments &&
           a.calls == b.calls && a.branch.function == b.branch.function &&
           a.branch.symbol == b.branch.symbol && a.branch.arguments == b.branch.arguments &&
           std::equal(a.branch.cases.begin(), a.branch.cases.end(), b.branch.cases.begin(),
                      b.branch.cases.end(), same_case);
  };
  return root == other.root && choices == other.choices &&
         std::equal(nodes.begin(), nodes.end(), other.nodes.begin(), other.nodes.end(), same_node);
}

std::string action_text(const Model& model, const PlanAction& step) {
  return arguments_text(model, model.actions[step.schema].name, step.arguments);
}

std::string case_text(const Model& model, const Plan::Branch& branch, Index value) {
  if (!branch.function)
    return (value != 0 ? "" : "!") +
           arguments_text(model, model.predicates[branch.symbol].name, branch.arguments);
  return arguments_text(model, model.functions[branch.symbol].name, branch.arguments) + " = " +
         model.objects[value].name;
}

PlanSize measure(const Model& model, const Plan& plan) {
  PlanSize size;
  struct Below {
    std::uint64_t actions = 0, leaves = 1, longest = 0;
    std::int64_t cost = 0;
  };
  std::vector<Below> below(plan.nodes.size());
  Below total;
  for (const Index i : bottom_up(plan)) {
    const Plan::Node& n = plan.nodes[i];
    Below b;
    b.leaves = 0;
    for (const Index next : successors(n)) {
      const Below child = next == kNone ? Below{} : below[next];
      b.actions = saturating(b.actions, child.actions);
      b.leaves = saturating(b.leaves, child.leaves);
      b.longest = std::max(b.longest, child.longest);
      b.cost = std::max(b.cost, child.cost);
    }
    if (n.branches) require_one_case_each(n.branch);
    if (n.acts) {
      b.actions = saturating(b.actions, 1);
      b.longest += 1;
      b.cost += cost_of(model, n.action);
    }
    ++size.nodes;
    size.branches += n.branches ? 1 : 0;
    total = below[i] = b;
  }
  size.tree_actions = total.actions;
  size.leaves = total.leaves;
  size.longest = total.longest;
  size.cost = total.cost;
  return size;
}

Plan expand_tree(const Plan& plan, std::size_t limit, const PlanProgress& progress) {
  bottom_up(plan);  // refuses cycles
  Plan tree;
  tree.not_certified = plan.not_certified;
  std::vector<std::pair<Index, Index>> todo;  // node of the plan, its copy
  const auto copy = [&](Index n) -> Index {
    if (n == kNone) return kNone;
    if (tree.nodes.size() >= limit)
      throw Error(ErrorCode::LimitReached,
                  "the tree has more than " + std::to_string(limit) + " nodes");
    tree.nodes.push_back(plan.nodes[n]);
    todo.emplace_back(n, static_cast<Index>(tree.nodes.size() - 1));
    return todo.back().second;
  };
  tree.root = copy(plan.root);
  for (std::size_t i = 0; i < todo.size(); ++i) {
    if (progress) progress();
    const auto [n, made] = todo[i];
    if (plan.nodes[n].branches) {
      for (std::size_t c = 0; c < plan.nodes[n].branch.cases.size(); ++c) {
        const Index next = copy(plan.nodes[n].branch.cases[c].next);
        tree.nodes[made].branch.cases[c].next = next;
      }
    } else {
      const Index next = copy(plan.nodes[n].next);
      tree.nodes[made].next = next;
    }
  }
  return tree;
}

}  // namespace kaboum::plan
