// A plan as a picture: steps in rows from the start down, every outcome of a branch with its own
// edge and label, every run's end a goal of its own.

#include <kaboum/base/error.h>
#include <kaboum/base/xml_text.h>
#include <kaboum/plan/plan.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "plan/layered_drawing.h"
#include "plan/plan_edges.h"

namespace kaboum::plan {
namespace {

// In pixels.
constexpr double kStepHeight = 28, kLabelHeight = 18, kGap = 16, kBorder = 20;
constexpr double kLetter = 7.9, kLabelLetter = 6.8;  ///< widths at the two sizes of type
constexpr Index kLongestEdge = 20;  ///< in rows; further down, a reference is drawn instead

/// The steps that a run can reach, each after all that lead to it, and in which row each stands:
/// its longest way from the root.
struct Rows {
  std::vector<Index> order;
  std::vector<Index> row;  ///< per step of the plan
};

/// @throws Error{InvalidInput} for graphs that are none of a plan
Rows rows_of(const PlanGraph& plan) {
  const auto fail = [](const std::string& what) {
    throw Error(ErrorCode::InvalidInput, "a plan's graph " + what);
  };
  Rows rows;
  rows.row.assign(plan.nodes.size(), 0);
  if (plan.root == kNone) return rows;
  if (plan.root >= plan.nodes.size()) fail("begins at a node that is not there");
  std::vector<std::size_t> incoming(plan.nodes.size(), 0);
  std::vector<char> reached(plan.nodes.size(), 0);
  std::vector<Index> todo{plan.root};
  reached[plan.root] = 1;
  while (!todo.empty()) {
    const Index n = todo.back();
    todo.pop_back();
    if (plan.nodes[n].next.empty()) fail("ends where there is no goal");
    for (const PlanGraph::Edge& e : plan.nodes[n].next) {
      if (e.to == kNone) continue;
      if (e.to >= plan.nodes.size()) fail("goes on at a node that is not there");
      ++incoming[e.to];
      if (reached[e.to]) continue;
      reached[e.to] = 1;
      todo.push_back(e.to);
    }
  }
  todo.push_back(plan.root);
  while (!todo.empty()) {
    const Index n = todo.back();
    todo.pop_back();
    rows.order.push_back(n);
    std::vector<PlanGraph::Edge> next = plan.nodes[n].next;
    std::reverse(next.begin(), next.end());  // the first outcome is drawn first
    for (const PlanGraph::Edge& e : next) {
      if (e.to == kNone) continue;
      rows.row[e.to] = std::max(rows.row[e.to], rows.row[n] + 1);
      if (--incoming[e.to] == 0) todo.push_back(e.to);
    }
  }
  // Of a cycle no node comes to have all before it in order.
  if (rows.order.size() != static_cast<std::size_t>(std::ranges::count(reached, 1)))
    fail("has a cycle");
  return rows;
}

enum class Kind : char { Start, Step, Branch, Goal, Reference, Label, Bend };

/// The drawing: the graph's node k is items[k]. Steps stand in even rows, labels in odd ones.
class Drawing {
 public:
  Drawing(const PlanGraph& plan, const PlanProgress& progress) : progress_(progress) {
    const Rows rows = rows_of(plan);
    const std::size_t start = add(0, Kind::Start, "");
    std::vector<std::size_t> item(plan.nodes.size(), 0);
    std::vector<char> referred(plan.nodes.size(), 0);
    const auto row = [&](Index n) { return 2 * (std::size_t{rows.row[n]} + 1); };
    const auto far = [&](Index from, Index to) {
      return rows.row[to] - rows.row[from] > kLongestEdge;
    };
    for (const Index n : rows.order)
      for (const PlanGraph::Edge& e : plan.nodes[n].next)
        if (e.to != kNone && far(n, e.to)) referred[e.to] = 1;
    for (const Index n : rows.order) {
      look();
      std::string text = plan.nodes[n].text;
      if (referred[n]) text += "  #" + std::to_string(n);
      item[n] = add(row(n), plan.nodes[n].branches ? Kind::Branch : Kind::Step, text);
      items_[item[n]].node = n;
    }
    if (plan.root == kNone) {
      lead(start, 0, "", add(2, Kind::Goal, "goal"), 2);
    } else {
      lead(start, 0, "", item[plan.root], 2);
    }
    for (const Index n : rows.order) {
      look();
      for (const PlanGraph::Edge& e : plan.nodes[n].next) {
        const std::size_t below = row(n) + 2;
        if (e.to == kNone) {
          lead(item[n], row(n), e.label, add(below, Kind::Goal, "goal"), below);
        } else if (far(n, e.to)) {
          lead(item[n], row(n), e.label,
               add(below, Kind::Reference, "goes on at #" + std::to_string(e.to)), below);
        } else {
          lead(item[n], row(n), e.label, item[e.to], row(e.to));
        }
      }
    }
  }

  std::string svg() {
    const double width = graph_.place(progress_) + 2 * kBorder;
    double y = kBorder;
    for (std::size_t r = 0; r < graph_.rows.size(); ++r) {
      const bool steps = r % 2 == 0;
      const bool labels = std::any_of(graph_.rows[r].begin(), graph_.rows[r].end(),
                                      [&](std::size_t i) { return items_[i].kind == Kind::Label; });
      const double height = steps ? (r == 0 ? 10 : kStepHeight) : labels ? kLabelHeight : 0;
      for (const std::size_t i : graph_.rows[r]) {
        items_[i].y = y + height / 2;
        items_[i].height = height;
      }
      y += height + kGap;
    }
    std::ostringstream out;
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << std::ceil(width)
        << "\" height=\"" << std::ceil(y - kGap + kBorder)
        << "\" font-family=\"monospace\" font-size=\"13\" text-anchor=\"middle\">\n"
        << "<defs><marker id=\"arrow\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" "
           "markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" "
           "fill=\"#606060\"/></marker></defs>\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (const std::vector<std::size_t>& edge : edges_) {
      look();
      draw_edge(out, edge);
    }
    for (std::size_t i = 0; i < items_.size(); ++i) {
      look();
      draw_item(out, i);
    }
    out << "</svg>\n";
    return out.str();
  }

 private:
  struct Item {
    Kind kind;
    std::string text;
    double box = 0;  ///< its width without the gap beside it
    double y = 0, height = 0;
    Index node = kNone;  ///< of the plan, of steps: their boxes have ids
  };

  void look() const {
    if (progress_) progress_();
  }

  std::size_t add(std::size_t row, Kind kind, std::string text) {
    const double letters = static_cast<double>(text.size());
    const double box = kind == Kind::Start   ? 10
                       : kind == Kind::Bend  ? 2
                       : kind == Kind::Label ? letters * kLabelLetter + 6
                                             : letters * kLetter + 16;
    items_.push_back({kind, std::move(text), box});
    return graph_.add(row, box + kGap);
  }

  /// An edge through a bend in every row between, the first of which is the label's.
  void lead(std::size_t from, std::size_t row, const std::string& label, std::size_t to,
            std::size_t to_row) {
    std::vector<std::size_t> edge{from};
    for (std::size_t r = row + 1; r < to_row; ++r) {
      const bool named = r == row + 1 && !label.empty();
      edge.push_back(add(r, named ? Kind::Label : Kind::Bend, named ? label : ""));
    }
    edge.push_back(to);
    for (std::size_t i = 1; i < edge.size(); ++i) graph_.connect(edge[i - 1], edge[i]);
    edges_.push_back(std::move(edge));
  }

  void draw_edge(std::ostream& out, const std::vector<std::size_t>& edge) const {
    out << "<path fill=\"none\" stroke=\"#808080\" marker-end=\"url(#arrow)\" d=\"";
    for (std::size_t k = 0; k < edge.size(); ++k) {
      const Item& item = items_[edge[k]];
      const double x = std::round(graph_.nodes[edge[k]].x + kBorder);
      const double top = item.y - item.height / 2, bottom = item.y + item.height / 2;
      // Straight down through every row, slanted only between rows: no edge runs behind a step.
      if (k == 0) {
        out << 'M' << x << ' ' << bottom;
      } else {
        out << 'L' << x << ' ' << top;
        if (k + 1 < edge.size() && bottom > top) out << 'L' << x << ' ' << bottom;
      }
    }
    out << "\"/>\n";
  }

  void draw_item(std::ostream& out, std::size_t i) const {
    const Item& item = items_[i];
    const double x = std::round(graph_.nodes[i].x + kBorder);
    const char* fill = "#f4f4f4";
    switch (item.kind) {
      case Kind::Bend:
        return;
      case Kind::Start:
        out << "<circle cx=\"" << x << "\" cy=\"" << item.y << "\" r=\"5\"/>\n";
        return;
      case Kind::Label:
        fill = "white";
        break;
      case Kind::Branch:
        fill = "#e8f0ff";
        break;
      case Kind::Goal:
        fill = "#e0f5e0";
        break;
      case Kind::Step:
      case Kind::Reference:
        break;
    }
    const bool label = item.kind == Kind::Label;
    out << "<rect x=\"" << x - item.box / 2 << "\" y=\"" << item.y - item.height / 2
        << "\" width=\"" << item.box << "\" height=\"" << item.height << "\" fill=\"" << fill;
    if (!label) out << "\" rx=\"5\" stroke=\"" << (item.kind == Kind::Reference ? "none" : "black");
    if (item.node != kNone) out << "\" id=\"node-" << item.node;
    out << "\"/>\n<text x=\"" << x << "\" y=\"" << item.y + 4;
    if (label) out << "\" fill=\"#0050a0\" font-size=\"11";
    out << "\">" << escape_xml(item.text) << "</text>\n";
  }

  const PlanProgress& progress_;
  LayeredGraph graph_;
  std::vector<Item> items_;
  std::vector<std::vector<std::size_t>> edges_;
};

}  // namespace

PlanGraph plan_graph(const Model& model, const Plan& plan) {
  measure(model, plan);  // refuses cycles
  PlanGraph out;
  out.root = plan.root;
  for (const Plan::Node& n : plan.nodes) {
    PlanGraph::Node& node = out.nodes.emplace_back();
    node.text = node_label(model, n);
    node.branches = n.branches;
    for (PlanEdge& e : plan_edges(model, n)) node.next.push_back({e.to, std::move(e.label)});
  }
  return out;
}

std::string plan_svg(const PlanGraph& graph, const PlanProgress& progress) {
  return Drawing(graph, progress).svg();
}

std::string plan_svg(const Model& model, const Plan& plan, const PlanProgress& progress) {
  return plan_svg(plan_graph(model, plan), progress);
}

}  // namespace kaboum::plan
