// A plan for people as indented text and as Graphviz DOT.
#include <kaboum/base/error.h>
#include <kaboum/plan/plan.h>

#include <algorithm>
#include <sstream>

#include "plan/plan_edges.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kLongestText = std::size_t{1} << 28U;

std::string escape_dot(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string plan_text(const Model& model, const Plan& plan, const PlanProgress& progress) {
  measure(model, plan);  // refuses cycles
  std::vector<std::size_t> parents(plan.nodes.size(), 0);
  for (const Plan::Node& n : plan.nodes)
    for (const PlanEdge& e : plan_edges(model, n))
      if (e.to != kNone) ++parents[e.to];
  std::ostringstream out;
  std::vector<char> printed(plan.nodes.size(), 0);
  struct Item {
    Index node;
    std::size_t depth;
    std::string label;
  };
  std::vector<Item> stack = {{plan.root, 0, ""}};
  if (!plan.not_certified.empty()) out << "(contacts " << plan.not_certified << ")\n";
  std::size_t length = 0;  // of the indentation
  while (!stack.empty()) {
    if (progress) progress();
    const Item item = stack.back();
    stack.pop_back();
    // Each branch indents what follows: a chain of very many is a text of their square.
    length += 2 * item.depth;
    if (length > kLongestText)
      throw Error(ErrorCode::LimitReached,
                  "the plan's text is longer than 256 MiB; draw it as DOT instead");
    const std::string indent(2 * item.depth, ' ');
    if (!item.label.empty())
      out << std::string(2 * (item.depth - 1), ' ') << "if " << item.label << ":\n";
    if (item.node == kNone) {
      out << indent << "(goal)\n";
      continue;
    }
    if (printed[item.node]) {
      out << indent << "(goes on at #" << item.node << ")\n";
      continue;
    }
    printed[item.node] = 1;
    const Plan::Node& n = plan.nodes[item.node];
    out << indent << node_label(model, n);
    if (parents[item.node] > 1) out << "   #" << item.node;
    out << '\n';
    std::vector<PlanEdge> next = plan_edges(model, n);
    std::reverse(next.begin(), next.end());
    for (const PlanEdge& e : next)
      stack.push_back({e.to, item.depth + (n.branches ? 1 : 0), e.label});
  }
  return out.str();
}

std::string plan_dot(const Model& model, const Plan& plan, const PlanProgress& progress) {
  std::ostringstream out;
  out << "digraph plan {\n  node [shape=box, fontname=\"sans-serif\"];\n  goal "
         "[shape=doublecircle];\n"
      << "  start [shape=point];\n  start -> ";
  const auto name = [](Index n) {
    return n == kNone ? std::string("goal") : "n" + std::to_string(n);
  };
  out << name(plan.root) << ";\n";
  if (!plan.not_certified.empty())
    out << "  label=\"contacts " << escape_dot(plan.not_certified) << "\"; labelloc=t;\n";
  for (Index i = 0; i < plan.nodes.size(); ++i) {
    if (progress) progress();
    const Plan::Node& n = plan.nodes[i];
    out << "  n" << i << " [label=\"" << escape_dot(node_label(model, n)) << "\""
        << (n.branches ? ", style=rounded" : "") << "];\n";
    for (const PlanEdge& e : plan_edges(model, n)) {
      out << "  n" << i << " -> " << name(e.to);
      if (!e.label.empty()) out << " [label=\"" << escape_dot(e.label) << "\"]";
      out << ";\n";
    }
  }
  out << "}\n";
  return out.str();
}

}  // namespace kaboum::plan
