// Paths in joint space: straight, else RRT-Connect. Source: [kuffner2000], with edges that are
// certified only once they are part of a path, and with samples that are left out as in
// [yershova2005]. docs/algorithms/motion-planning.md.

#include <kaboum/motion/path_finder.h>

#include <array>

#include "path_finder_impl.h"
#include "path_query.h"
#include "shorten.h"
#include "tree.h"

namespace kaboum::motion {
namespace {

using Certain = world::MotionAnswer::Outcome;

class TreeSearch {
 public:
  TreeSearch(SearchSpace& space, PathQuery& query, const Values& start,
             std::span<const Values> goals, const PathOptions& options)
      : space_(space),
        query_(query),
        start_(start),
        goals_(goals),
        options_(options),
        random_(options.seed) {}

  void run() {
    space_.draw_around(start_, goals_);
    grow();
  }

 private:
  /// Steps that samples are away from a node next to an obstacle, at most.
  static constexpr double kDomain = 2;
  /// Of samples that are farther away, one in so many is taken.
  static constexpr std::size_t kTaken = 16;

  void grow() {
    std::array<Tree, 2> trees;
    trees[0].add_root(start_);
    for (const std::size_t g : query_.order()) trees[1].add_root(goals_[g]);
    std::size_t near = 0, far_away = 0;
    for (;;) {
      if (const auto outcome = space_.ended()) return query_.end(*outcome);
      const Values sample = space_.sample(random_);
      const std::size_t from = trees[near].nearest(sample, space_);
      if (trees[near][from].is_next_to_obstacle &&
          space_.distance(trees[near].at(from), sample) > kDomain * space_.range() &&
          ++far_away % kTaken != 0)
        continue;
      const std::size_t node = step(trees[near], near == 1, from, sample, nullptr);
      if (node == Tree::kNone) trees[near].set_next_to_obstacle(from);
      if (node != Tree::kNone) {
        const Values q = trees[near].at(node);
        const std::size_t other = connect(trees[1 - near], near == 0, q);
        if (other != Tree::kNone &&
            (near == 0 ? join(trees, node, other) : join(trees, other, node)))
          return;
      }
      if (trees[1 - near].size() < trees[near].size()) near = 1 - near;
    }
  }

  /// A step from the nearest node towards q. @return the new node; kNone: something is in the way.
  /// @param back  the tree's edges are gone towards its roots
  std::size_t extend(Tree& tree, bool back, const Values& q, bool* reached) {
    return step(tree, back, tree.nearest(q, space_), q, reached);
  }

  std::size_t step(Tree& tree, bool back, std::size_t from, const Values& q, bool* reached) {
    const Values here = tree.at(from);
    const double distance = space_.distance(here, q);
    const bool whole = distance <= space_.range();
    Values to = whole ? q : between(here, q, space_.range() / distance);
    if (reached != nullptr) *reached = whole;
    // A node of the other tree is on the constraints, a sample is not.
    const bool is_node = whole && reached != nullptr;
    if (space_.has_constraints() && !is_node && (!space_.project(to) || !is_progress(here, to, q)))
      return Tree::kNone;
    const auto way = space_.way(here, to, back);
    if (!way) return Tree::kNone;
    const Values* last = &here;
    for (const Values& waypoint : *way) {
      ++space_.spent().nodes;
      const bool certain =
          back ? space_.is_known_free(waypoint, *last) : space_.is_known_free(*last, waypoint);
      from = tree.add(waypoint, from, certain);
      last = &waypoint;
    }
    return from;
  }

  /// Whether a step, projected onto the constraints, still leads on.
  bool is_progress(const Values& from, const Values& to, const Values& towards) const {
    constexpr double kLeastStep = 0.05, kLongestStep = 2;  // in parts of a whole one
    const double length = space_.distance(from, to);
    return length >= kLeastStep * std::min(space_.range(), space_.distance(from, towards)) &&
           length <= kLongestStep * space_.range();
  }

  /// Steps towards q until it is reached. @return the node at q; kNone: something is in the way.
  std::size_t connect(Tree& tree, bool back, const Values& q) {
    bool reached = false;
    std::size_t node = extend(tree, back, q, &reached);
    while (node != Tree::kNone && !reached && !space_.ended()) {
      const double before = space_.distance(tree.at(node), q);
      node = step(tree, back, node, q, &reached);
      // On constraints, steps may lead round in circles.
      if (node != Tree::kNone && !reached && space_.distance(tree.at(node), q) >= before)
        return Tree::kNone;
    }
    return reached ? node : Tree::kNone;
  }

  /// The path over two nodes at the same place, if all of it is certainly free; else the edge that
  /// is not is removed.
  bool join(std::array<Tree, 2>& trees, std::size_t first, std::size_t second) {
    if (!certify(trees[0], false, first) || !certify(trees[1], true, second)) return false;
    robot::Path path;
    for (const std::size_t i : trees[0].branch(first)) path.push_back(trees[0].at(i));
    const std::vector<std::size_t> back = trees[1].branch(second);
    for (std::size_t i = back.size() - 1; i-- > 0;) path.push_back(trees[1].at(back[i]));
    const std::size_t goal = query_.order()[trees[1][second].root];
    return query_.accept(shorten(path, space_, options_.shortcuts, random_), goal) ||
           query_.accept(path, goal);
  }

  /// Whether the branch is certainly free; else the first edge that is not is removed.
  bool certify(Tree& tree, bool back, std::size_t node) {
    const std::vector<std::size_t> branch = tree.branch(node);
    std::size_t begin = 0;
    while (begin + 1 < branch.size() && tree[branch[begin + 1]].certain) ++begin;
    robot::Path path;
    for (std::size_t i = begin; i < branch.size(); ++i) path.push_back(tree.at(branch[i]));
    if (path.size() < 2) return true;
    if (back && space_.decides_motions()) return certify_back(tree, branch, begin);
    const world::MotionAnswer answer = space_.check(path);
    const bool free = answer.outcome == Certain::Free;
    const std::size_t certain = free ? path.size() - 1 : answer.segment;
    for (std::size_t i = 0; i < certain; ++i) tree.set_certain(branch[begin + 1 + i]);
    if (!free) tree.remove(branch[begin + 1 + certain]);
    return free;
  }

  /// The same for edges that were looked at the other way.
  bool certify_back(Tree& tree, const std::vector<std::size_t>& branch, std::size_t begin) {
    for (std::size_t i = begin; i + 1 < branch.size(); ++i) {
      if (space_.check({tree.at(branch[i + 1]), tree.at(branch[i])}).outcome != Certain::Free) {
        tree.remove(branch[i + 1]);
        return false;
      }
      tree.set_certain(branch[i + 1]);
    }
    return true;
  }

  SearchSpace& space_;
  PathQuery& query_;
  const Values& start_;
  std::span<const Values> goals_;
  const PathOptions& options_;
  Random random_;
};

PathAnswer search(SearchSpace& space, const Values& start, std::span<const Values> goals,
                  const PathOptions& options) {
  PathQuery query(space, start, goals);
  if (query.look_at_ends() && !query.go_straight()) grow_trees(space, query, start, goals, options);
  return query.take();
}

}  // namespace

const char* name_of(PathAnswer::Outcome outcome) {
  static constexpr std::array<const char*, 10> kNames{"found",
                                                      "start outside limits",
                                                      "goal outside limits",
                                                      "start in contact",
                                                      "goal in contact",
                                                      "start breaks a constraint",
                                                      "goal breaks a constraint",
                                                      "work ended",
                                                      "nodes ended",
                                                      "time ended"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

void grow_trees(SearchSpace& space, PathQuery& query, const Values& start,
                std::span<const Values> goals, const PathOptions& options) {
  TreeSearch(space, query, start, goals, options).run();
}

PathAnswer find_path(const world::Checker& checker, const world::WorldState& state,
                     std::size_t robot, const Values& start, std::span<const Values> goals,
                     const PathOptions& options) {
  require_query(checker, state, robot, start, goals, options);
  const Metric metric = metric_of(checker, state, robot);
  SearchMemory memory;
  SearchSpace space(checker, state, robot, start, options, metric, memory);
  return search(space, start, goals, options);
}

PathFinder::PathFinder(const world::Checker& checker, world::WorldState state, std::size_t robot,
                       const filter::BatchChecker::Options& options)
    : impl_(std::make_unique<Impl>(checker, std::move(state), robot, options)) {}
PathFinder::~PathFinder() = default;
PathFinder::PathFinder(PathFinder&&) noexcept = default;
PathFinder& PathFinder::operator=(PathFinder&&) noexcept = default;

const world::Checker& PathFinder::checker() const { return *impl_->checker; }
const world::WorldState& PathFinder::state() const { return impl_->state; }
std::size_t PathFinder::robot() const { return impl_->robot; }

PathAnswer PathFinder::find(const Values& start, std::span<const Values> goals,
                            const PathOptions& options) const {
  Impl& s = *impl_;
  require_query(*s.checker, s.state, s.robot, start, goals, options);
  const Impl::Borrowed memory(s);
  SearchSpace space(*s.checker, s.state, s.robot, start, options, s.metric, *memory);
  return search(space, start, goals, options);
}

}  // namespace kaboum::motion
