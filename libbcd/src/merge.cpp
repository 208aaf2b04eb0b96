// Hulls are merged, cheapest first. Source: [gaschler2016] §4.4; [mamou2009] joins clusters in the
// same way.

#include "merge.h"

#include <kaboum/base/parallel.h>

#include <cmath>
#include <queue>

namespace kaboum::bcd {
namespace {

constexpr double kMergeWork = 0.8;  ///< share of the work allowed, after which merging ends
/// Bodies that do not touch are only merged when there are no more: all pairs are looked at.
constexpr std::size_t kAllPairs = 400;

/// So many hulls are built at once: a fixed number, so that the work is the same on any number of
/// threads.
constexpr std::size_t kAtOnce = 8;

/// Two bodies, and what their hull costs, or a bound below.
struct Pair {
  std::uint32_t a, b;
  double cost = 0;
  bool known = false;  ///< whether that is the cost
};

/// Cheapest first; ties by index, so that the order is always the same.
bool later(const Pair& p, const Pair& q) {
  if (p.cost != q.cost) return p.cost > q.cost;
  return p.a != q.a ? p.a > q.a : p.b > q.b;
}

class Merger {
 public:
  Merger(std::vector<Body> bodies, const SolidField& solid, double epsilon, double volume_weight,
         PairMemo& memo)
      : bodies_(std::move(bodies)),
        solid_(solid),
        epsilon_(epsilon),
        volume_weight_(volume_weight),
        memo_(memo),
        alive_(bodies_.size(), 1),
        count_(bodies_.size()) {
    id_.reserve(bodies_.size());
    for (const Body& b : bodies_) id_.push_back(memo_.id_of(b.leaves));
  }

  void run(std::size_t target) {
    propose_pairs([&](std::uint32_t a, std::uint32_t b) { return near(a, b); });
    // Where any distance will do, the number is what is asked for.
    const bool unlimited = !std::isfinite(epsilon_);
    bool all_pairs = false;
    while (count_ > target && (unlimited || !solid_.work().spent(kMergeWork))) {
      if (queue_.empty()) {
        // Parts that do not touch may still share a hull.
        if (all_pairs || count_ > kAllPairs) break;
        all_pairs = true;
        propose_pairs([&](std::uint32_t a, std::uint32_t b) {
          return alive_[a] != 0 && alive_[b] != 0 && !near(a, b);
        });
        if (queue_.empty()) break;
      }
      if (!queue_.top().known) {
        estimate_next();
        continue;
      }
      const Pair p = queue_.top();
      queue_.pop();
      if (alive_[p.a] == 0 || alive_[p.b] == 0) continue;
      if (!join(p)) continue;
      const auto self = static_cast<std::uint32_t>(bodies_.size()) - 1;
      for (std::uint32_t a = 0; a < self; ++a)
        if (alive_[a] != 0 && (all_pairs || near(a, self))) fresh_.push_back({a, self});
      bound_fresh();
    }
  }

  std::vector<Body> result() {
    std::vector<Body> out;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (alive_[i] != 0) out.push_back(std::move(bodies_[i]));
    return out;
  }

 private:
  [[nodiscard]] bool near(std::uint32_t a, std::uint32_t b) const {
    return touch(bodies_[a], bodies_[b], solid_);
  }

  template <class Predicate>
  void propose_pairs(Predicate&& wanted) {
    for (std::uint32_t a = 0; a < bodies_.size(); ++a)
      for (std::uint32_t b = a + 1; b < bodies_.size(); ++b)
        if (wanted(a, b)) fresh_.push_back({a, b});
    bound_fresh();
  }

  void take(Pair& p, const UnionEstimate& hull) {
    p.cost = hull.worst + volume_weight_ * hull.added;
    p.known = true;
    if (hull.worst <= epsilon_) queue_.push(p);
  }

  /// Puts fresh pairs into the queue that are not known to be too far from the solid. A hull is no
  /// nearer than what is in it.
  void bound_fresh() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < fresh_.size(); ++i) {
      Pair& p = fresh_[i];
      const UnionEstimate* known = memo_.find(id_[p.a], id_[p.b]);
      if (known != nullptr && (known->whole || known->worst > epsilon_)) {
        take(p, *known);
      } else {
        open.push_back(i);
      }
    }
    parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
      Pair& p = fresh_[open[i]];
      p.cost = distance_from_below(bodies_[p.a], bodies_[p.b], solid_, epsilon_);
    });
    for (const std::size_t i : open) {
      const Pair& p = fresh_[i];
      if (p.cost <= epsilon_) {
        queue_.push(p);
      } else {
        memo_.add(id_[p.a], id_[p.b], {p.cost, 0, false});
      }
    }
    fresh_.clear();
  }

  /// Finds the costs of the pairs that have the least bounds.
  void estimate_next() {
    std::vector<Pair> next;
    while (next.size() < kAtOnce && !queue_.empty() && !queue_.top().known) {
      const Pair p = queue_.top();
      queue_.pop();
      if (alive_[p.a] != 0 && alive_[p.b] != 0) next.push_back(p);
    }
    std::vector<UnionEstimate> hulls(next.size());
    parallel_for(std::size_t{0}, next.size(), [&](std::size_t i) {
      hulls[i] = estimate_hull(bodies_[next[i].a], bodies_[next[i].b], solid_, epsilon_);
    });
    for (std::size_t i = 0; i < next.size(); ++i) {
      memo_.add(id_[next[i].a], id_[next[i].b], hulls[i]);
      take(next[i], hulls[i]);
    }
  }

  /// @return whether the hull is not too far after all, looked at more densely.
  bool join(const Pair& p) {
    Body merged = union_of(bodies_[p.a], bodies_[p.b], solid_);
    if (std::isfinite(epsilon_)) {
      if (const auto far = far_point(merged, solid_, epsilon_)) {
        memo_.add(id_[p.a], id_[p.b], {far->distance, 0, false});
        return false;
      }
    }
    alive_[p.a] = alive_[p.b] = 0;
    bodies_[p.a].hull = {};
    bodies_[p.b].hull = {};
    --count_;
    id_.push_back(memo_.id_of(merged.leaves));
    bodies_.push_back(std::move(merged));
    alive_.push_back(1);
    return true;
  }

  std::vector<Body> bodies_;
  const SolidField& solid_;
  double epsilon_, volume_weight_;
  PairMemo& memo_;
  std::vector<std::uint32_t> id_;  // in the memo, per body
  std::vector<char> alive_;
  std::size_t count_;
  std::vector<Pair> fresh_;
  std::priority_queue<Pair, std::vector<Pair>, decltype(&later)> queue_{&later};
};

}  // namespace

std::vector<Body> merge(std::vector<Body> bodies, const SolidField& solid, std::size_t target,
                        double epsilon, double volume_weight, PairMemo& memo) {
  Merger merger(std::move(bodies), solid, epsilon, volume_weight, memo);
  merger.run(target);
  return merger.result();
}

}  // namespace kaboum::bcd
