// A plan for people: indented text, Graphviz DOT, and SVG drawn here.
#include <kaboum/geom/error.h>
#include <kaboum/plan/plan.h>

#include <algorithm>
#include <sstream>

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

std::string escape_xml(const std::string& s) {
  std::string out;
  for (const char c : s) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

struct Edge {
  Index to;
  std::string label;
};

std::vector<Edge> edges(const Model& model, const Plan::Node& n) {
  if (!n.branches) return {{n.next, ""}};
  std::vector<Edge> result;
  for (const Plan::Branch::Case& c : n.branch.cases)
    result.push_back({c.next, case_text(model, n.branch, c.value)});
  return result;
}

std::string label(const Model& model, const Plan::Node& n) {
  return n.acts ? step_text(model, n.action) : "branch";
}

}  // namespace

std::string plan_text(const Model& model, const Plan& plan) {
  measure(model, plan);  // refuses cycles
  std::vector<std::size_t> parents(plan.nodes.size(), 0);
  for (const Plan::Node& n : plan.nodes)
    for (const Edge& e : edges(model, n))
      if (e.to != kNone) ++parents[e.to];
  std::ostringstream out;
  std::vector<char> printed(plan.nodes.size(), 0);
  struct Item {
    Index node;
    std::size_t depth;
    std::string label;
  };
  std::vector<Item> stack = {{plan.root, 0, ""}};
  std::size_t length = 0;  // of the indentation
  while (!stack.empty()) {
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
    out << indent << label(model, n);
    if (parents[item.node] > 1) out << "   #" << item.node;
    out << '\n';
    std::vector<Edge> next = edges(model, n);
    std::reverse(next.begin(), next.end());
    for (const Edge& e : next) stack.push_back({e.to, item.depth + (n.branches ? 1 : 0), e.label});
  }
  return out.str();
}

std::string plan_dot(const Model& model, const Plan& plan) {
  std::ostringstream out;
  out << "digraph plan {\n  node [shape=box, fontname=\"sans-serif\"];\n  goal "
         "[shape=doublecircle];\n"
      << "  start [shape=point];\n  start -> ";
  const auto name = [](Index n) {
    return n == kNone ? std::string("goal") : "n" + std::to_string(n);
  };
  out << name(plan.root) << ";\n";
  for (Index i = 0; i < plan.nodes.size(); ++i) {
    const Plan::Node& n = plan.nodes[i];
    out << "  n" << i << " [label=\"" << escape_dot(label(model, n)) << "\""
        << (n.branches ? ", style=rounded" : "") << "];\n";
    for (const Edge& e : edges(model, n)) {
      out << "  n" << i << " -> " << name(e.to);
      if (!e.label.empty()) out << " [label=\"" << escape_dot(e.label) << "\"]";
      out << ";\n";
    }
  }
  out << "}\n";
  return out.str();
}

std::string plan_svg(const Model& model, const Plan& plan) {
  measure(model, plan);  // refuses cycles
  // Layers by longest distance from the root; the goal comes last.
  std::vector<Index> layer(plan.nodes.size(), 0);
  std::vector<Index> order;
  std::vector<std::size_t> incoming(plan.nodes.size(), 0);
  std::vector<char> reached(plan.nodes.size(), 0);
  std::vector<Index> todo;
  if (plan.root != kNone) {
    todo.push_back(plan.root);
    reached[plan.root] = 1;
  }
  while (!todo.empty()) {
    const Index n = todo.back();
    todo.pop_back();
    for (const Edge& e : edges(model, plan.nodes[n])) {
      if (e.to == kNone) continue;
      ++incoming[e.to];
      if (reached[e.to]) continue;
      reached[e.to] = 1;
      todo.push_back(e.to);
    }
  }
  if (plan.root != kNone) todo.push_back(plan.root);
  while (!todo.empty()) {
    const Index n = todo.back();
    todo.pop_back();
    order.push_back(n);
    for (const Edge& e : edges(model, plan.nodes[n])) {
      if (e.to == kNone) continue;
      layer[e.to] = std::max(layer[e.to], layer[n] + 1);
      if (--incoming[e.to] == 0) todo.push_back(e.to);
    }
  }
  Index last = 0;
  for (const Index n : order) last = std::max(last, layer[n] + 1);
  std::vector<std::vector<Index>> rows(last + 1);
  for (const Index n : order) rows[layer[n]].push_back(n);
  rows[last].push_back(kNone);

  constexpr int kRow = 70;
  constexpr int kHeight = 28;
  std::size_t longest = 4;
  std::size_t widest = 1;
  for (const Index n : order) longest = std::max(longest, label(model, plan.nodes[n]).size());
  for (const auto& row : rows) widest = std::max(widest, row.size());
  const int box = static_cast<int>(longest) * 8 + 16;
  const int column = box + 60;
  const int width = static_cast<int>(widest) * column + 40;
  const int height = static_cast<int>(rows.size()) * kRow + 40;
  struct Spot {
    int x, y;
  };
  std::vector<Spot> spot(plan.nodes.size());
  Spot goal{};
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      const Spot s{width / 2 + static_cast<int>(2 * i + 1) * column / 2 -
                       static_cast<int>(rows[r].size()) * column / 2,
                   40 + static_cast<int>(r) * kRow};
      (rows[r][i] == kNone ? goal : spot[rows[r][i]]) = s;
    }
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\"" << height
      << "\" font-family=\"monospace\" font-size=\"13\" text-anchor=\"middle\">\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (const Index n : order)
    for (const Edge& e : edges(model, plan.nodes[n])) {
      const Spot a = spot[n];
      const Spot b = e.to == kNone ? goal : spot[e.to];
      out << "<line x1=\"" << a.x << "\" y1=\"" << a.y + kHeight / 2 << "\" x2=\"" << b.x
          << "\" y2=\"" << b.y - kHeight / 2 << "\" stroke=\"gray\"/>\n";
      if (!e.label.empty())
        out << "<text x=\"" << (2 * a.x + b.x) / 3 << "\" y=\"" << (2 * a.y + b.y) / 3 + 10
            << "\" fill=\"#0050a0\" font-size=\"11\">" << escape_xml(e.label) << "</text>\n";
    }
  const auto draw = [&](Spot s, const std::string& text, int w, const char* fill) {
    out << "<rect x=\"" << s.x - w / 2 << "\" y=\"" << s.y - kHeight / 2 << "\" width=\"" << w
        << "\" height=\"" << kHeight << "\" rx=\"5\" fill=\"" << fill
        << "\" stroke=\"black\"/>\n<text x=\"" << s.x << "\" y=\"" << s.y + 4 << "\">"
        << escape_xml(text) << "</text>\n";
  };
  for (const Index n : order)
    draw(spot[n], label(model, plan.nodes[n]), box, plan.nodes[n].branches ? "#e8f0ff" : "#f4f4f4");
  draw(goal, "goal", 56, "#e0f5e0");
  out << "</svg>\n";
  return out.str();
}

}  // namespace kaboum::plan
