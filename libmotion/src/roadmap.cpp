// Roadmaps: configurations and motions that are decided once, for many queries. Source:
// [kavraki1996].

#include <kaboum/base/error.h>
#include <kaboum/base/read_json.h>
#include <kaboum/base/sha256.h>
#include <kaboum/motion/roadmap.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/margins.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <queue>
#include <set>

#include "path_finder_impl.h"
#include "path_query.h"
#include "shorten.h"

namespace kaboum::motion {
namespace {

using nlohmann::json;
using Certain = world::MotionAnswer::Outcome;

constexpr std::size_t kDrawnPerNode = 100;  ///< at most
constexpr std::size_t kNearest = 30;        ///< nodes that an end of a query may be joined to
constexpr std::size_t kJoined = 4;          ///< so many are enough
constexpr std::size_t kMostNodes = 1'000'000;
constexpr double kLargestValue = 1e9;         ///< of a variable, as in paths
constexpr std::size_t kMotionsAtOnce = 4096;  ///< between calls of a progress

class Hashed {
 public:
  void add(double x) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%a ", x);
    text_ += buffer;
  }
  void add(const geom::Transform& t) {
    for (int i = 0; i < 9; ++i) add(t.linear(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) add(t.translation[i]);
  }
  void add(const std::string& name) { text_ += std::to_string(name.size()) + ":" + name + "\n"; }
  void add(const collide::BoundingSet& set) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      add(set.body(i).radius);
      for (const geom::Vec3& p : set.body(i).core.vertices)
        for (int k = 0; k < 3; ++k) add(p[k]);
    }
  }
  [[nodiscard]] std::string digest() const { return sha256(text_); }

 private:
  std::string text_ = "roadmap 1\n";
};

/// Ends and edges of a query in a roadmap.
class RoadmapSearch {
 public:
  RoadmapSearch(SearchSpace& space, PathQuery& query, const Values& start,
                std::span<const Values> goals, const PathOptions& options,
                const std::vector<double>& values, const std::vector<std::uint32_t>& first,
                const std::vector<std::uint32_t>& others)
      : space_(space),
        query_(query),
        start_(start),
        goals_(goals),
        options_(options),
        values_(values),
        first_(first),
        others_(others),
        random_(options.seed) {}

  /// Whether the query has its answer.
  bool run() {
    const std::size_t count = first_.size() - 1;
    goal_edges_.resize(count);
    for (const std::size_t node : joined(start_, false)) start_edges_.push_back(node);
    for (const std::size_t g : query_.order())
      for (const std::size_t node : joined(goals_[g], true)) goal_edges_[node].push_back(g);
    for (;;) {
      if (const auto outcome = space_.ended()) {
        query_.end(*outcome);
        return true;
      }
      std::size_t goal = 0;
      const std::vector<std::size_t> nodes = shortest(goal);
      if (nodes.empty()) return false;
      robot::Path path{start_};
      for (const std::size_t node : nodes) path.push_back(at(node));
      path.push_back(goals_[goal]);
      const world::MotionAnswer answer = space_.check(path);
      if (answer.outcome != Certain::Free) {
        leave_out(nodes, answer.segment, goal);
        continue;
      }
      return query_.accept(shorten(path, space_, options_.shortcuts, random_), goal) ||
             query_.accept(path, goal);
    }
  }

 private:
  [[nodiscard]] Values at(std::size_t node) const {
    const double* q = values_.data() + node * start_.size();
    return {q, q + start_.size()};
  }

  /// Nodes near an end that a motion from it, or to it, leads to.
  std::vector<std::size_t> joined(const Values& end, bool to) {
    const std::size_t count = first_.size() - 1;
    space_.count_nodes(count);
    std::vector<std::pair<double, std::size_t>> near(count);
    for (std::size_t i = 0; i < count; ++i)
      near[i] = {space_.squared_distance(values_.data() + i * end.size(), end.data()), i};
    const auto most = static_cast<std::ptrdiff_t>(std::min(kNearest, count));
    std::partial_sort(near.begin(), near.begin() + most, near.end());
    std::vector<std::size_t> out;
    for (auto it = near.begin(); it != near.begin() + most && out.size() < kJoined; ++it) {
      if (space_.ended()) break;
      const Values node = at(it->second);
      if (to ? space_.looks_free(node, end) : space_.looks_free(end, node))
        out.push_back(it->second);
    }
    return out;
  }

  void leave_out(const std::vector<std::size_t>& nodes, std::size_t segment, std::size_t goal) {
    if (segment == 0)
      std::erase(start_edges_, nodes.front());
    else if (segment == nodes.size())
      std::erase(goal_edges_[nodes.back()], goal);
    else
      left_out_.insert({std::min(nodes[segment - 1], nodes[segment]),
                        std::max(nodes[segment - 1], nodes[segment])});
  }

  /// The nodes of a shortest way from the start to a goal (Dijkstra); empty: there is none.
  std::vector<std::size_t> shortest(std::size_t& goal) {
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    const std::size_t count = first_.size() - 1, n = start_.size();
    std::vector<double> length(count, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> before(count, kNone);
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    std::size_t seen = count;
    const auto reach = [&](std::size_t node, double l, std::size_t from) {
      if (l >= length[node]) return;
      length[node] = l;
      before[node] = from;
      open.push({l, node});
    };
    const auto distance = [&](const double* a, const double* b) {
      return std::sqrt(space_.squared_distance(a, b));
    };
    for (const std::size_t node : start_edges_)
      reach(node, distance(start_.data(), values_.data() + node * n), kNone);
    double best = std::numeric_limits<double>::infinity();
    std::size_t last = kNone;
    while (!open.empty()) {
      const auto [l, node] = open.top();
      open.pop();
      ++seen;
      if (l >= best) break;
      if (l > length[node]) continue;
      seen += first_[node + 1] - first_[node];
      const double* q = values_.data() + node * n;
      for (const std::size_t g : goal_edges_[node])
        if (const double whole = l + distance(q, goals_[g].data()); whole < best) {
          best = whole;
          last = node;
          goal = g;
        }
      for (std::uint32_t k = first_[node]; k < first_[node + 1]; ++k) {
        const std::size_t other = others_[k];
        if (!left_out_.empty() &&
            left_out_.contains({std::min(node, other), std::max(node, other)}))
          continue;
        reach(other, l + distance(q, values_.data() + other * n), node);
      }
    }
    space_.count_nodes(seen);
    std::vector<std::size_t> out;
    for (; last != kNone; last = before[last]) out.push_back(last);
    std::ranges::reverse(out);
    return out;
  }

  SearchSpace& space_;
  PathQuery& query_;
  const Values& start_;
  std::span<const Values> goals_;
  const PathOptions& options_;
  const std::vector<double>& values_;
  const std::vector<std::uint32_t>&first_, &others_;
  Random random_;
  std::vector<std::size_t> start_edges_;              ///< nodes
  std::vector<std::vector<std::size_t>> goal_edges_;  ///< goals, of each node
  std::set<std::array<std::size_t, 2>> left_out_;     ///< edges that are not free
};

}  // namespace

std::string identity_of(const world::Checker& checker, const world::WorldState& state,
                        std::size_t robot) {
  const world::World& world = checker.world();
  const world::RobotModel& model = world.robots[robot];
  world::WorldState at = state;
  at.q[robot] = model.home;
  Hashed hashed;
  hashed.add(model.name);
  hashed.add(model.fingerprint);
  hashed.add(model.base);
  for (const robot::Variable& v : model.kinematics.variables) {
    hashed.add(v.name);
    hashed.add(v.lower.value_or(-HUGE_VAL));
    hashed.add(v.upper.value_or(HUGE_VAL));
  }
  const auto is_there = [&](const world::Item& item) {
    const auto& absent = item.robot == world::Item::kObject ? at.absent : at.absent_robots;
    const std::size_t i = item.robot == world::Item::kObject ? item.index : item.robot;
    return absent.empty() || !absent[i];
  };
  world::Scratch scratch;
  std::set<world::Item> items;
  for (const auto& [a, b] : checker.pairs(at, {})) {
    hashed.add(world.name_of(a));
    hashed.add(world.name_of(b));
    hashed.add(margin_between(world, at, a, b));
    items.insert({a, b});
  }
  for (const world::Item& item : items) {
    hashed.add(world.name_of(item));
    hashed.add(world.outer(item));
    if (is_there(item)) hashed.add(checker.places(at, {item}, scratch).front().place.pose());
  }
  return hashed.digest();
}

Roadmap::Roadmap(const PathFinder& finder, const RoadmapOptions& options) {
  if (options.nodes == 0 || options.neighbours == 0)
    throw Error(ErrorCode::InvalidArgument, "a roadmap has nodes and neighbours");
  if (options.nodes > kMostNodes)
    throw Error(ErrorCode::InvalidArgument,
                "a roadmap of more than " + std::to_string(kMostNodes) + " nodes");
  const PathFinder::Impl& f = *finder.impl_;
  const robot::Robot& robot = f.checker->world().robots[f.robot].kinematics;
  scene_ = identity_of(*f.checker, f.state, f.robot);
  const std::size_t n = variables_ = robot.variables.size();
  const auto tell = [&](const std::string& stage) {
    if (options.check.progress) options.check.progress(stage);
  };

  // Drawn in parts of a fixed size, so that the same are kept whatever decides them.
  Random random(options.seed);
  std::vector<double> drawn;
  std::vector<std::uint8_t> free;
  const std::size_t part = std::max<std::size_t>(options.nodes, 64);
  for (std::size_t all = 0; nodes() < options.nodes && all < kDrawnPerNode * options.nodes;
       all += part) {
    tell(std::to_string(nodes()) + " nodes");
    drawn.clear();
    for (std::size_t i = 0; i < part; ++i)
      for (const robot::Variable& v : robot.variables) {
        const double turn = robot::is_angle(robot, v) ? 3.2 : 1;
        drawn.push_back(random.between(v.lower.value_or(v.upper.value_or(turn) - 2 * turn),
                                       v.upper.value_or(v.lower.value_or(-turn) + 2 * turn)));
      }
    free.assign(part, 0);
    f.batch.decide(drawn, free);
    for (std::size_t i = 0; i < part && nodes() < options.nodes; ++i)
      if (free[i] != 0)
        values_.insert(values_.end(), drawn.begin() + static_cast<std::ptrdiff_t>(i * n),
                       drawn.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
  }

  const auto distance = [&](std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double d = f.metric.weight[k] * (values_[b * n + k] - values_[a * n + k]);
      sum += d * d;
    }
    return sum;
  };
  std::set<std::array<std::uint32_t, 2>> wanted;
  std::vector<std::pair<double, std::uint32_t>> near;
  for (std::uint32_t i = 0; i < nodes(); ++i) {
    if (i % 256 == 0) tell("neighbours of " + std::to_string(i) + " nodes");
    near.clear();
    for (std::uint32_t k = 0; k < nodes(); ++k)
      if (k != i) near.emplace_back(distance(i, k), k);
    const auto most = static_cast<std::ptrdiff_t>(std::min(options.neighbours, near.size()));
    std::partial_sort(near.begin(), near.begin() + most, near.end());
    for (auto it = near.begin(); it != near.begin() + most; ++it)
      wanted.insert({std::min(i, it->second), std::max(i, it->second)});
  }
  std::vector<double> from, to;
  for (const auto& [a, b] : wanted)
    for (std::size_t k = 0; k < n; ++k) {
      from.push_back(values_[a * n + k]);
      to.push_back(values_[b * n + k]);
    }
  free.assign(wanted.size(), 0);
  for (std::size_t i = 0; i < free.size(); i += kMotionsAtOnce) {
    const std::size_t count = std::min(kMotionsAtOnce, free.size() - i);
    tell(std::to_string(i) + " of " + std::to_string(free.size()) + " motions");
    f.batch.decide_motions(std::span(from).subspan(i * n, count * n),
                           std::span(to).subspan(i * n, count * n),
                           std::span(free).subspan(i, count), options.check);
  }
  std::size_t i = 0;
  for (const auto& [a, b] : wanted)
    if (free[i++] != 0) edges_.push_back({a, b});
  arrange();
}

std::size_t Roadmap::nodes() const { return variables_ == 0 ? 0 : values_.size() / variables_; }

void Roadmap::arrange() {
  first_.assign(nodes() + 1, 0);
  for (const Edge& e : edges_) {
    ++first_[e.a + 1];
    ++first_[e.b + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  others_.resize(2 * edges_.size());
  std::vector<std::uint32_t> next = first_;
  for (const Edge& e : edges_) {
    others_[next[e.a]++] = e.b;
    others_[next[e.b]++] = e.a;
  }
}

PathAnswer Roadmap::find(const PathFinder& finder, const Values& start,
                         std::span<const Values> goals, const PathOptions& options) const {
  PathFinder::Impl& f = *finder.impl_;
  if (f.identity() != scene_)
    throw Error(ErrorCode::InvalidArgument,
                "the roadmap is of another scene, state or robot; make it anew");
  if (!options.constraints.empty()) return finder.find(start, goals, options);
  require_query(*f.checker, f.state, f.robot, start, goals, options);
  const PathFinder::Impl::Borrowed memory(f);
  SearchSpace space(*f.checker, f.state, f.robot, start, options, f.metric, *memory);
  PathQuery query(space, start, goals);
  if (query.look_at_ends() && !query.go_straight() &&
      !RoadmapSearch(space, query, start, goals, options, values_, first_, others_).run())
    grow_trees(space, query, start, goals, options);
  return query.take();
}

std::string Roadmap::to_json() const {
  json nodes_json = json::array(), edges_json = json::array();
  for (std::size_t i = 0; i < nodes(); ++i)
    nodes_json.push_back(
        std::vector<double>(values_.begin() + static_cast<std::ptrdiff_t>(i * variables_),
                            values_.begin() + static_cast<std::ptrdiff_t>((i + 1) * variables_)));
  for (const Edge& e : edges_) edges_json.push_back({e.a, e.b});
  return json{{"roadmap", 1}, {"scene", scene_}, {"nodes", nodes_json}, {"edges", edges_json}}
             .dump() +
         "\n";
}

Roadmap Roadmap::from_json(std::string_view text, const std::string& name,
                           const PathFinder& finder) {
  const auto fail = [&](const std::string& what) {
    return Error(ErrorCode::InvalidInput, name + ": " + what);
  };
  PathFinder::Impl& f = *finder.impl_;
  Roadmap out;
  const robot::Robot& robot = f.checker->world().robots[f.robot].kinematics;
  out.variables_ = robot.variables.size();
  const json read = read_json<json>(text, name, "make the roadmap anew");
  if (!read.is_object() || !read.contains("roadmap") || read["roadmap"] != 1)
    throw fail("this is no roadmap");
  if (!read.contains("scene") || read["scene"] != f.identity())
    throw fail("the roadmap is of another scene, state or robot; make it anew");
  out.scene_ = f.identity();
  if (!read.contains("nodes") || !read["nodes"].is_array()) throw fail("'nodes' are missing");
  for (const json& node : read["nodes"]) {
    if (!node.is_array() || node.size() != out.variables_)
      throw fail("'nodes': a node is " + std::to_string(out.variables_) + " numbers");
    for (const json& x : node) {
      if (!x.is_number()) throw fail("'nodes': a node has a value that is no number");
      out.values_.push_back(x.get<double>());
    }
    const auto last = std::span(out.values_).last(out.variables_);
    if (const auto bad = find_out_of_limits(robot, last))
      throw fail("'nodes': node " + std::to_string(out.nodes() - 1) + " has '" +
                 robot.variables[*bad].name + "' outside its limits");
    if (std::ranges::any_of(last, [](double x) { return !(std::abs(x) <= kLargestValue); }))
      throw fail("'nodes': node " + std::to_string(out.nodes() - 1) + " has a value beyond 1e9");
  }
  if (!read.contains("edges") || !read["edges"].is_array()) throw fail("'edges' are missing");
  for (const json& edge : read["edges"]) {
    if (!edge.is_array() || edge.size() != 2 || !edge[0].is_number_unsigned() ||
        !edge[1].is_number_unsigned() || edge[0] >= out.nodes() || edge[1] >= out.nodes() ||
        edge[0] == edge[1])
      throw fail("'edges': an edge is two different nodes, counted from 0");
    out.edges_.push_back({edge[0].get<std::uint32_t>(), edge[1].get<std::uint32_t>()});
  }
  out.arrange();
  return out;
}

}  // namespace kaboum::motion
