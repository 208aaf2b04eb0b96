// Drawings of plans: nothing overlaps what it does not belong to.

#include <random>
#include <regex>
#include <set>

#include "plan/layered_drawing.h"
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

TEST(LayeredGraph, NodesOfARowDoNotOverlap) {
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    LayeredGraph graph;
    const std::size_t rows = 2 + random() % 6;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t i = 0, n = 1 + random() % 8; i < n; ++i)
        graph.add(r, 1 + static_cast<double>(random() % 40));
    for (std::size_t r = 1; r < rows; ++r)
      for (const std::size_t lower : graph.rows[r])
        graph.connect(graph.rows[r - 1][random() % graph.rows[r - 1].size()], lower);
    const double width = graph.place();
    for (const auto& row : graph.rows) {
      double right = 0;
      for (const std::size_t n : row) {
        const auto& node = graph.nodes[n];
        EXPECT_GE(node.x - node.width / 2, right - 1e-6);
        right = node.x + node.width / 2;
      }
      EXPECT_LE(right, width + 1e-6);
    }
  }
}

TEST(LayeredGraph, ATreesEdgesDoNotCross) {
  LayeredGraph graph;
  const std::size_t root = graph.add(0, 10);
  const std::size_t a = graph.add(1, 10), b = graph.add(1, 10);
  graph.connect(root, a);
  graph.connect(root, b);
  // In the wrong order.
  const std::size_t below_b = graph.add(2, 10), below_a = graph.add(2, 10);
  graph.connect(a, below_a);
  graph.connect(b, below_b);
  graph.place();
  EXPECT_EQ(graph.nodes[a].x < graph.nodes[b].x, graph.nodes[below_a].x < graph.nodes[below_b].x);
}

struct Box {
  double x, y, width, height;
  [[nodiscard]] bool meets(const Box& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
  [[nodiscard]] bool holds(double px, double py) const {
    return px > x && px < x + width && py > y && py < y + height;
  }
};

struct Picture {
  std::vector<Box> boxes;
  std::vector<std::vector<std::pair<double, double>>> edges;
};

Picture parse(const std::string& svg) {
  Picture picture;
  const std::regex rect(
      "<rect x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
  for (std::sregex_iterator m(svg.begin(), svg.end(), rect), end; m != end; ++m)
    picture.boxes.push_back(
        {std::stod((*m)[1]), std::stod((*m)[2]), std::stod((*m)[3]), std::stod((*m)[4])});
  const std::regex path("marker-end=\"[^\"]*\" d=\"([^\"]*)\""), point("([-0-9.]+) ([-0-9.]+)");
  for (std::sregex_iterator m(svg.begin(), svg.end(), path), end; m != end; ++m) {
    const std::string d = (*m)[1];
    picture.edges.emplace_back();
    for (std::sregex_iterator p(d.begin(), d.end(), point); p != end; ++p)
      picture.edges.back().emplace_back(std::stod((*p)[1]), std::stod((*p)[2]));
  }
  return picture;
}

/// Labels are boxes that their own edge runs through, behind the text; a step's box no edge enters.
void expect_readable(const std::string& svg, std::size_t steps) {
  const Picture picture = parse(svg);
  ASSERT_GE(picture.boxes.size(), steps);
  ASSERT_GE(picture.edges.size(), steps);
  for (std::size_t i = 0; i < picture.boxes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_FALSE(picture.boxes[i].meets(picture.boxes[k])) << i << " and " << k;
  std::vector<std::set<std::size_t>> through(picture.boxes.size());
  for (std::size_t e = 0; e < picture.edges.size(); ++e) {
    const auto& line = picture.edges[e];
    for (std::size_t i = 1; i < line.size(); ++i)
      for (int s = 0; s <= 20; ++s) {
        const double t = s / 20.0;
        const double x = (1 - t) * line[i - 1].first + t * line[i].first;
        const double y = (1 - t) * line[i - 1].second + t * line[i].second;
        for (std::size_t b = 0; b < picture.boxes.size(); ++b)
          if (picture.boxes[b].holds(x, y)) through[b].insert(e);
      }
  }
  for (std::size_t b = 0; b < through.size(); ++b)
    EXPECT_LE(through[b].size(), picture.boxes[b].height < 20 ? 1U : 0U) << b;
}

TEST(Drawing, NothingOverlaps) {
  for (const char* n : {"1", "2"}) {
    const Model m = scenario("force-sensing", n);
    const Plan plan = solved(m, Algorithm::BreadthFirst).plan;
    expect_readable(plan_svg(m, plan), plan.nodes.size());
    const Plan tree = expand_tree(plan);
    expect_readable(plan_svg(m, tree), tree.nodes.size());
  }
}

TEST(Drawing, LongEdgesAreReferences) {
  const Model m = model_of("predicates: p\ninit: Kw(p)\ngoal: true");
  Plan plan;
  plan.nodes.resize(60);
  for (Index i = 0; i < 60; ++i) {
    plan.nodes[i].branches = true;
    plan.nodes[i].branch = {false, 0, {}, {{1, i + 1 == 60 ? kNone : i + 1}, {0, 59}}};
    if (i == 59) plan.nodes[i].branch.cases[1].next = kNone;
  }
  plan.root = 0;
  const std::string svg = plan_svg(m, plan);
  EXPECT_NE(svg.find("goes on at #59"), std::string::npos);
  EXPECT_NE(svg.find("branch  #59"), std::string::npos);
}

TEST(Drawing, AnEmptyPlanIsAGoal) {
  const Model m = model_of("predicates: p\ninit: p\ngoal: K(p)");
  Plan plan;
  plan.root = kNone;
  const Picture picture = parse(plan_svg(m, plan));
  EXPECT_EQ(picture.boxes.size(), 1U);
  EXPECT_EQ(picture.edges.size(), 1U);
}

TEST(Drawing, GraphsThatAreNoneOfAPlanAreRefused) {
  const auto refused = [](const PlanGraph& graph, const std::string& why) {
    try {
      plan_svg(graph);
      ADD_FAILURE() << "drawn, though it " << why;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  const PlanGraph::Node end{"a", {{kNone, ""}}, false}, to_first{"b", {{0, ""}}, false};
  refused({{end}, 1}, "begins at a node that is not there");
  refused({{{"a", {{3, ""}}, false}}, 0}, "goes on at a node that is not there");
  refused({{{"a", {}, false}}, 0}, "ends where there is no goal");
  refused({{to_first}, 0}, "cycle");
  refused({{{"a", {{1, "p"}, {kNone, "!p"}}, true}, to_first}, 0}, "cycle");
  EXPECT_NE(plan_svg(PlanGraph{{end, to_first}, 1}).find("id=\"node-1\""), std::string::npos);
}

}  // namespace
}  // namespace kaboum::plan::test
