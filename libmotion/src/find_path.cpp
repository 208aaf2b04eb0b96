// Paths in joint space: straight, else RRT-Connect. Source: [kuffner2000], with edges that are
// certified only once they are part of a path. docs/algorithms/motion-planning.md.

#include <kaboum/base/error.h>
#include <kaboum/motion/find_path.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "search_space.h"
#include "shorten.h"
#include "tree.h"

namespace kaboum::motion {
namespace {

using Outcome = PathAnswer::Outcome;
using Certain = world::MotionAnswer::Outcome;

class PathSearch {
 public:
  PathSearch(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
             const Values& start, std::span<const Values> goals, const PathOptions& options)
      : space_(checker, state, robot, start, options),
        start_(start),
        goals_(goals),
        options_(options),
        random_(options.seed) {}

  PathAnswer run() {
    search();
    answer_.blockers = space_.blockers();
    answer_.spent = space_.spent();
    return std::move(answer_);
  }

 private:
  void search() {
    if (!look_at_start() || !look_at_goals()) return;
    if (go_straight()) return;
    space_.draw_around(start_, goals_);
    grow();
  }

  void end(Outcome outcome) { answer_.outcome = outcome; }

  bool look_at_start() {
    if (const auto outside = find_out_of_limits(space_.kinematics(), start_)) {
      answer_.variable = *outside;
      end(Outcome::StartOutsideLimits);
      return false;
    }
    answer_.contact = space_.find_contact(start_);
    if (answer_.contact) {
      end(Outcome::StartInContact);
      return false;
    }
    answer_.broken = space_.find_broken({start_});
    if (answer_.broken) end(Outcome::StartBreaksConstraint);
    return !answer_.broken;
  }

  /// Keeps the goals that can be reached, the nearest first.
  bool look_at_goals() {
    std::optional<std::uint32_t> variable;
    std::optional<world::Contact> contact;
    std::optional<ConstraintAnswer> broken;
    for (std::size_t g = 0; g < goals_.size(); ++g) {
      if (const auto outside = find_out_of_limits(space_.kinematics(), goals_[g])) {
        if (!variable) variable = outside;
      } else if (auto met = space_.find_contact(goals_[g])) {
        if (!contact) contact = std::move(met);
      } else if (auto not_kept = space_.find_broken({goals_[g]})) {
        // One that is not certain is told of: then nothing is known of all.
        if (!broken || not_kept->outcome == ConstraintAnswer::Outcome::Undecided)
          broken = std::move(not_kept);
      } else {
        order_.push_back(g);
      }
    }
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return space_.distance(start_, goals_[a]) < space_.distance(start_, goals_[b]);
    });
    if (!order_.empty()) return true;
    if (broken) {
      answer_.broken = std::move(broken);
      end(Outcome::GoalBreaksConstraint);
    } else if (contact) {
      answer_.contact = std::move(contact);
      end(Outcome::GoalInContact);
    } else {
      answer_.variable = *variable;
      end(Outcome::GoalOutsideLimits);
    }
    return false;
  }

  /// The only way to an answer with a path: what is returned has been decided as it is.
  bool accept(const robot::Path& path, std::size_t goal) {
    if (space_.check(path).outcome != Certain::Free || space_.find_broken(path)) return false;
    answer_.deviations = space_.deviations();
    answer_.path = path;
    answer_.goal = goal;
    end(Outcome::Found);
    return true;
  }

  bool go_straight() {
    for (const std::size_t g : order_) {
      const auto way = space_.way(start_, goals_[g]);
      if (!way) continue;
      robot::Path path{start_};
      path.insert(path.end(), way->begin(), way->end());
      if (path.size() > 2) path = without_detours(path, space_);
      if (!accept(path, g)) continue;
      answer_.straight = path.size() == 2;
      return true;
    }
    return false;
  }

  void grow() {
    std::array<Tree, 2> trees;
    trees[0].add_root(start_);
    for (const std::size_t g : order_) trees[1].add_root(goals_[g]);
    std::size_t near = 0;
    for (;;) {
      if (const auto outcome = space_.ended()) return end(*outcome);
      const std::size_t node = extend(trees[near], space_.sample(random_), nullptr);
      if (node != Tree::kNone) {
        const Values q = trees[near][node].q;
        const std::size_t other = connect(trees[1 - near], q);
        if (other != Tree::kNone &&
            (near == 0 ? join(trees, node, other) : join(trees, other, node)))
          return;
      }
      if (trees[1 - near].size() < trees[near].size()) near = 1 - near;
    }
  }

  /// A step from the nearest node towards q. @return the new node; kNone: something is in the way.
  std::size_t extend(Tree& tree, const Values& q, bool* reached) {
    return step(tree, tree.nearest(q, space_), q, reached);
  }

  std::size_t step(Tree& tree, std::size_t from, const Values& q, bool* reached) {
    const double distance = space_.distance(tree[from].q, q);
    const bool whole = distance <= space_.range();
    Values to = whole ? q : between(tree[from].q, q, space_.range() / distance);
    if (reached != nullptr) *reached = whole;
    // A node of the other tree is on the constraints, a sample is not.
    const bool is_node = whole && reached != nullptr;
    if (space_.has_constraints() && !is_node &&
        (!space_.project(to) || !is_progress(tree[from].q, to, q)))
      return Tree::kNone;
    const auto way = space_.way(tree[from].q, to);
    if (!way) return Tree::kNone;
    for (const Values& waypoint : *way) {
      ++space_.spent().nodes;
      from = tree.add(waypoint, from);
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
  std::size_t connect(Tree& tree, const Values& q) {
    bool reached = false;
    std::size_t node = extend(tree, q, &reached);
    while (node != Tree::kNone && !reached && !space_.ended()) {
      const double before = space_.distance(tree[node].q, q);
      node = step(tree, node, q, &reached);
      // On constraints, steps may lead round in circles.
      if (node != Tree::kNone && !reached && space_.distance(tree[node].q, q) >= before)
        return Tree::kNone;
    }
    return reached ? node : Tree::kNone;
  }

  /// The path over two nodes at the same place, if all of it is certainly free; else the edge that
  /// is not is removed.
  bool join(std::array<Tree, 2>& trees, std::size_t first, std::size_t second) {
    if (!certify(trees[0], first) || !certify(trees[1], second)) return false;
    robot::Path path;
    for (const std::size_t i : trees[0].branch(first)) path.push_back(trees[0][i].q);
    const std::vector<std::size_t> back = trees[1].branch(second);
    for (std::size_t i = back.size() - 1; i-- > 0;) path.push_back(trees[1][back[i]].q);
    const std::size_t goal = order_[trees[1][second].root];
    return accept(shorten(path, space_, options_.shortcuts, random_), goal) || accept(path, goal);
  }

  bool certify(Tree& tree, std::size_t node) {
    const std::vector<std::size_t> branch = tree.branch(node);
    std::size_t begin = 0;
    while (begin + 1 < branch.size() && tree[branch[begin + 1]].certain) ++begin;
    robot::Path path;
    for (std::size_t i = begin; i < branch.size(); ++i) path.push_back(tree[branch[i]].q);
    if (path.size() < 2) return true;
    const world::MotionAnswer answer = space_.check(path);
    const bool free = answer.outcome == Certain::Free;
    const std::size_t certain = free ? path.size() - 1 : answer.segment;
    for (std::size_t i = 0; i < certain; ++i) tree.set_certain(branch[begin + 1 + i]);
    if (!free) tree.remove(branch[begin + 1 + certain]);
    return free;
  }

  SearchSpace space_;
  const Values& start_;
  std::span<const Values> goals_;
  const PathOptions& options_;
  Random random_;
  std::vector<std::size_t> order_;  ///< of the goals
  PathAnswer answer_;
};

}  // namespace

const char* name_of(Outcome outcome) {
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

PathAnswer find_path(const world::Checker& checker, const world::WorldState& state,
                     std::size_t robot, const Values& start, std::span<const Values> goals,
                     const PathOptions& options) {
  if (goals.empty()) throw Error(ErrorCode::InvalidArgument, "a path without a goal");
  if (!(options.most_work > 0) || !(options.most_seconds > 0) || options.most_nodes == 0)
    throw Error(ErrorCode::InvalidArgument, "limits of a search must be above 0");
  require_fits(checker, state, robot, start);
  for (const Values& goal : goals) require_fits(checker, state, robot, goal);
  for (const PathConstraint& constraint : options.constraints)
    require_keepable(constraint, checker.world().robots[robot].kinematics);
  return PathSearch(checker, state, robot, start, goals, options).run();
}

}  // namespace kaboum::motion
