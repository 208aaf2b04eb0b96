// Trees of configurations.

#include "tree.h"

#include <algorithm>
#include <limits>

namespace kaboum::motion {

std::size_t Tree::add_root(const Values& q) {
  variables_ = q.size();
  values_.insert(values_.end(), q.begin(), q.end());
  nodes_.push_back({kNone, nodes_.size(), true, false, false});
  ++living_;
  return nodes_.size() - 1;
}

std::size_t Tree::add(const Values& q, std::size_t parent, bool certain) {
  values_.insert(values_.end(), q.begin(), q.end());
  nodes_.push_back({parent, nodes_[parent].root, certain, false, false});
  ++living_;
  return nodes_.size() - 1;
}

std::size_t Tree::nearest(const Values& q, SearchSpace& space) const {
  space.count_nodes(nodes_.size());
  std::size_t best = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].gone) continue;
    const double d = space.squared_distance(values_.data() + i * variables_, q.data());
    if (d < least || best == kNone) {
      least = d;
      best = i;
    }
  }
  return best;
}

std::vector<std::size_t> Tree::branch(std::size_t node) const {
  std::vector<std::size_t> out;
  for (; node != kNone; node = nodes_[node].parent) out.push_back(node);
  std::reverse(out.begin(), out.end());
  return out;
}

void Tree::remove(std::size_t node) {
  nodes_[node].gone = true;
  --living_;
  // Children come after their parents.
  for (std::size_t i = node + 1; i < nodes_.size(); ++i)
    if (!nodes_[i].gone && nodes_[i].parent != kNone && nodes_[nodes_[i].parent].gone) {
      nodes_[i].gone = true;
      --living_;
    }
}

}  // namespace kaboum::motion
