#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cut_chooser.h"
#include "cut_node.h"

namespace kaboum::bcd {

/// Binary tree of cuts. Leaves that are still open to cutting hold their piece.
class CutTree {
 public:
  using Node = CutNode;

  /// @param safety  multiplies the overlap of neighbouring pieces.
  CutTree(const SolidField& solid, const SearchOptions& options, double safety = 1);
  /// The same tree, not cut yet: as long as nothing else is done than by the other one, it is cut
  /// by the planes that were chosen there, which is all it saves.
  /// @param solid  the same one, with as much known of it.
  CutTree(const CutTree& same, const SolidField& solid);

  /// Cuts the leaf with the largest distance. @return false when no leaf can be
  /// cut.
  bool cut_worst();
  /// Judges all nodes anew, by the witnesses that there are now.
  void reestimate();
  /// Judges the nodes round a witness that was added now.
  void reestimate(const SolidField::Witness& witness);
  /// Cuts this leaf. @return false when no plane cuts it.
  bool cut(int leaf);
  /// Cuts this leaf by this plane. @pre something is in it.
  void cut(int leaf, const Plane& plane);

  /// Cuts this leaf across the longest side of the box along the axes of its
  /// hull's covariance: for parts that are near enough, but have too many
  /// vertices. @return false when that cuts nothing.
  bool halve(int leaf);

  /// A plane that parts what is in these nodes, and the larger distance of the
  /// two hulls.
  struct Split {
    Plane plane;
    double worst = std::numeric_limits<double>::infinity();
  };
  /// The plane with the smallest distance, if that is below `limit`, among some
  /// across `direction` and the axes.
  [[nodiscard]] std::optional<Split> find_split(const std::vector<int>& nodes,
                                                const Vec3& direction, double limit) const;
  /// Sorts nodes by the sides of a plane: in place of those that it crosses the
  /// ones that they were cut into, and leaves are cut.
  void split(std::vector<int> nodes, const Plane& plane, std::vector<int>& lower,
             std::vector<int>& upper);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] std::vector<int> leaves() const;
  /// The leaves when there were this many for the first time; all, if there
  /// never were.
  [[nodiscard]] std::vector<int> leaves(std::size_t count) const;
  /// In place of these nodes the coarsest within this distance, and the leaves
  /// that are farther.
  [[nodiscard]] std::vector<int> nodes_within(double distance, std::vector<int> nodes = {0}) const;
  /// Appends what a node was cut into: one or two nodes; none for a leaf.
  void append_children(int node, std::vector<int>& out) const;
  /// Appends the leaves that a node was cut into, itself when it was not.
  void leaves_below(int node, std::vector<int>& out) const;
  [[nodiscard]] bool is_leaf(int node) const {
    return nodes_[node].lower < 0 && nodes_[node].upper < 0;
  }
  [[nodiscard]] std::size_t leaf_count() const { return leaf_count_; }
  /// Largest distance among the leaves that can be cut.
  [[nodiscard]] double worst() const;
  [[nodiscard]] double shift() const { return shift_; }

 private:
  [[nodiscard]] Side side_of(int node, const Plane& plane) const;
  void add_leaf(Piece&& piece, int parent);
  [[nodiscard]] std::pair<double, double> extent_of(const std::vector<int>& nodes,
                                                    const Vec3& n) const;
  [[nodiscard]] double worst_half(const std::vector<int>& nodes, const Plane& plane,
                                  double limit) const;

  /// The plane that was chosen for the worst leaf, if any helps, and the work of choosing it.
  struct Choice {
    std::optional<Plane> plane;
    std::uint64_t work;
  };
  std::optional<Plane> choose(int leaf);
  std::optional<Plane> choose_for_worst(int leaf);
  bool cut_chosen(int leaf, const std::optional<Plane>& plane);
  void cut_by(int leaf, const Plane& plane);

  const SolidField& solid_;
  double shift_;  // half the overlap of neighbouring pieces [length]
  CutChooser chooser_;
  std::vector<Node> nodes_;
  std::size_t leaf_count_ = 0;
  // While nothing is done but that the worst leaves are cut, what is chosen for them follows from
  // the solid and the options: those known, in turn, and how many of them have been taken.
  std::vector<Choice> choices_;
  std::size_t chosen_ = 0;
  bool only_worst_ = true;
};

}  // namespace kaboum::bcd
