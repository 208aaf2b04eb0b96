
#include <kaboum/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "search.h"

namespace kaboum::bcd {
namespace {

constexpr double kMergeWork = 0.8;  ///< share of the work allowed, after which merging ends

/// Two bodies and what their hull would be.
struct Pair {
  std::uint32_t a, b;
  PairMemo::Entry hull{};
  double cost = 0;
};

/// Cheapest first; ties by index, so that the order is always the same.
bool later(const Pair& p, const Pair& q) {
  if (p.cost != q.cost) return p.cost > q.cost;
  return p.a != q.a ? p.a > q.a : p.b > q.b;
}

geom::HullBuilder& hull_builder() {
  static thread_local geom::HullBuilder builder;
  return builder;
}

void join(const Body& a, const Body& b, std::vector<Vec3>& points) {
  points.assign(a.hull.begin(), a.hull.end());
  points.insert(points.end(), b.hull.begin(), b.hull.end());
}

/// Distance of some points between the bodies.
double between(const Body& a, const Body& b, const Solid& solid) {
  constexpr std::size_t kSamples = 12;
  double worst = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vec3& p = a.hull[i * a.hull.size() / kSamples];
    const Vec3& q = b.hull[(i * 5 % kSamples) * b.hull.size() / kSamples];
    const Vec3 middle = 0.5 * (p + q);
    worst = std::max(worst, solid.distance_above(worst, middle, solid.field(middle)));
  }
  return worst;
}

/// Pairs farther than `limit` from the solid are not looked at any closer.
PairMemo::Entry judge(const Body& a, const Body& b, const Solid& solid, double limit) {
  solid.work().add(2000);
  const double least = between(a, b, solid);
  if (least > limit) return {least, 0, false};
  static thread_local std::vector<Vec3> points;
  join(a, b, points);
  const Appraisal h = appraise(points, solid, hull_builder(), true, limit);
  const double added = std::max(0.0, h.volume - a.appraisal.volume - b.appraisal.volume);
  return {h.worst, std::cbrt(added), h.worst <= limit};
}

Body body_round(const std::vector<Vec3>& points, const Solid& solid, std::vector<int> leaves) {
  Body body;
  geom::HullBuilder& builder = hull_builder();
  body.appraisal = appraise(points, solid, builder);
  if (body.appraisal.flat) {
    body.hull = points;
  } else {
    for (const std::uint32_t v : builder.vertices()) body.hull.push_back(points[v]);
  }
  for (const Vec3& p : body.hull) body.box.extend(p);
  body.leaves = std::move(leaves);
  return body;
}

}  // namespace

Body body_of(const CutTree& tree, int leaf) {
  const CutTree::Node& node = tree.nodes()[leaf];
  Body body{node.hull, {leaf}, node.appraisal, {}};
  for (const Vec3& p : body.hull) body.box.extend(p);
  return body;
}

Body union_of(const CutTree& tree, const Solid& solid, const std::vector<int>& leaves) {
  std::vector<Vec3> points;
  for (const int leaf : leaves) {
    const std::vector<Vec3>& hull = tree.nodes()[leaf].hull;
    points.insert(points.end(), hull.begin(), hull.end());
  }
  return body_round(points, solid, leaves);
}

Body union_of(const Body& a, const Body& b, const Solid& solid) {
  std::vector<Vec3> points;
  join(a, b, points);
  std::vector<int> leaves = a.leaves;
  leaves.insert(leaves.end(), b.leaves.begin(), b.leaves.end());
  std::sort(leaves.begin(), leaves.end());
  return body_round(points, solid, std::move(leaves));
}

double distance_of_union(const Body& a, const Body& b, const Solid& solid, double limit) {
  return judge(a, b, solid, limit).worst;
}

bool touch(const Body& a, const Body& b, const Solid& solid) {
  const double reach = 1e-3 * solid.diagonal();
  return ((a.box.min.array() - reach <= b.box.max.array()) &&
          (b.box.min.array() - reach <= a.box.max.array()))
      .all();
}

std::vector<Body> merge(std::vector<Body> bodies, const Solid& solid, std::size_t target,
                        double epsilon, double bulk, PairMemo& memo) {
  std::vector<std::uint32_t> id;
  id.reserve(bodies.size());
  for (const Body& b : bodies) id.push_back(memo.id_of(b.leaves));
  std::vector<char> alive(bodies.size(), 1);
  std::size_t count = bodies.size();
  const auto near = [&](const Body& a, const Body& b) { return touch(a, b, solid); };
  std::priority_queue<Pair, std::vector<Pair>, decltype(&later)> queue(&later);
  std::vector<Pair> fresh;
  const auto judge_all = [&] {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      Pair& p = fresh[i];
      const PairMemo::Entry* known = memo.find(id[p.a], id[p.b]);
      if (known != nullptr && (known->whole || known->worst > epsilon)) {
        p.hull = *known;
      } else {
        open.push_back(i);
      }
    }
    parallel_loop(std::size_t{0}, open.size(), [&](std::size_t i) {
      Pair& p = fresh[open[i]];
      p.hull = judge(bodies[p.a], bodies[p.b], solid, epsilon);
    });
    for (const std::size_t i : open) memo.add(id[fresh[i].a], id[fresh[i].b], fresh[i].hull);
    for (Pair& p : fresh) {
      p.cost = p.hull.worst + bulk * p.hull.added;
      if (p.hull.worst <= epsilon) queue.push(p);
    }
    fresh.clear();
  };
  for (std::uint32_t a = 0; a < bodies.size(); ++a)
    for (std::uint32_t b = a + 1; b < bodies.size(); ++b)
      if (near(bodies[a], bodies[b])) fresh.push_back({a, b});
  judge_all();
  // Where any distance will do, the number is what is wished.
  const bool unlimited = !std::isfinite(epsilon);
  bool all_pairs = false;
  while (count > target && (unlimited || !solid.work().spent(kMergeWork))) {
    if (queue.empty()) {
      // Parts that do not touch may still share a hull.
      if (all_pairs || count > 400) break;
      all_pairs = true;
      for (std::uint32_t a = 0; a < bodies.size(); ++a)
        for (std::uint32_t b = a + 1; b < bodies.size(); ++b)
          if (alive[a] != 0 && alive[b] != 0 && !near(bodies[a], bodies[b]))
            fresh.push_back({a, b});
      judge_all();
      if (queue.empty()) break;
    }
    const Pair p = queue.top();
    queue.pop();
    if (alive[p.a] == 0 || alive[p.b] == 0) continue;
    Body merged = union_of(bodies[p.a], bodies[p.b], solid);
    alive[p.a] = alive[p.b] = 0;
    bodies[p.a].hull = {};
    bodies[p.b].hull = {};
    --count;
    const auto self = static_cast<std::uint32_t>(bodies.size());
    id.push_back(memo.id_of(merged.leaves));
    bodies.push_back(std::move(merged));
    alive.push_back(1);
    for (std::uint32_t a = 0; a < self; ++a)
      if (alive[a] != 0 && (all_pairs || near(bodies[a], bodies[self]))) fresh.push_back({a, self});
    judge_all();
  }
  std::vector<Body> out;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (alive[i] != 0) out.push_back(std::move(bodies[i]));
  return out;
}

}  // namespace kaboum::bcd
