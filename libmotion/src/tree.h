#pragma once

#include "search_space.h"

namespace kaboum::motion {

/// A tree of configurations. Edges look free; they are certain only where that is said.
class Tree {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Node {
    std::size_t parent = kNone;
    std::size_t root = 0;
    bool certain = false;  ///< the edge to the parent is free at every instant
    bool gone = false;
    bool is_next_to_obstacle = false;  ///< a step from here did not get through
  };

  std::size_t add_root(const Values& q);
  /// @param certain  the edge is free at every instant
  std::size_t add(const Values& q, std::size_t parent, bool certain);
  /// The node at the least distance.
  [[nodiscard]] std::size_t nearest(const Values& q, SearchSpace& space) const;
  /// From a root to the node.
  [[nodiscard]] std::vector<std::size_t> branch(std::size_t node) const;
  /// A node that cannot be reached from its parent, and all that hang from it.
  void remove(std::size_t node);

  [[nodiscard]] const Node& operator[](std::size_t i) const { return nodes_[i]; }
  [[nodiscard]] Values at(std::size_t i) const {
    const double* q = values_.data() + i * variables_;
    return {q, q + variables_};
  }
  void set_next_to_obstacle(std::size_t node) { nodes_[node].is_next_to_obstacle = true; }
  void set_certain(std::size_t node) { nodes_[node].certain = true; }
  [[nodiscard]] std::size_t size() const { return living_; }

 private:
  std::vector<Node> nodes_;
  std::size_t variables_ = 0;
  std::vector<double> values_;  ///< of the nodes, one after the other
  std::size_t living_ = 0;
};

}  // namespace kaboum::motion
