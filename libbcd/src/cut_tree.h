#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "concavity.h"
#include "piece.h"

namespace kaboum::bcd {

struct SearchOptions {
  int offsets = 7;  ///< per direction
  int reflex_planes = 10;
  int refinements = 2;  ///< halvings of the best plane's offset
  bool mirrors = true;  ///< try the solid's planes of symmetry
  /// Of this many of the best cuts, the one is taken after which the next cuts bring most; ≤ 1: the
  /// best by itself.
  int look_ahead = 1;
  /// Bonus of a cut that halves a piece's volume, as a share of its score: for a given number of
  /// bodies, it makes them more alike. By an error bound, where slices are needed that only faces
  /// of the solid give, it has led to hundreds of bodies too many.
  double halving_bonus = 0;
  /// Chooses the planes instead, given a cell and the hull of what is in it; none: not to be cut.
  std::function<std::optional<Plane>(const Cell&, const std::vector<Vec3>&)> choose = {};
};

/// Binary tree of cuts. Leaves that are still open to cutting hold their piece.
class CutTree {
 public:
  struct Node {
    Piece piece;             ///< empty once cut
    std::vector<Vec3> hull;  ///< vertices of the hull
    Concavity concavity;
    int parent = -1, lower = -1, upper = -1;
    Plane plane;
    bool stuck = false;  ///< no plane makes it better
    int stale_cuts = 0;  ///< cuts above it that brought neither half nearer
  };

  /// @param safety  multiplies the overlap of neighbouring pieces.
  CutTree(const SolidField& solid, const SearchOptions& options, double safety = 1);

  /// Cuts the leaf with the largest distance. @return false when no leaf can be cut.
  bool cut_worst();
  /// Judges all nodes anew, by the witnesses that there are now.
  void reestimate();
  /// Judges the nodes round a witness that was added anew.
  void reestimate(const SolidField::Witness& witness);
  /// Cuts this leaf. @return false when no plane cuts it.
  bool cut(int leaf);

  /// Cuts this leaf across the longest side of the box along the axes of its hull's covariance: for
  /// parts that are near enough, but have too many vertices. @return false when that cuts nothing.
  bool halve(int leaf);

  /// A plane that parts what is in these nodes, and the larger distance of the two hulls.
  struct Split {
    Plane plane;
    double worst = std::numeric_limits<double>::infinity();
  };
  /// The plane with the smallest distance, if that is below `limit`, among some across `direction`
  /// and the axes.
  [[nodiscard]] std::optional<Split> find_split(const std::vector<int>& nodes,
                                                const Vec3& direction, double limit) const;
  /// Sorts nodes by the sides of a plane: in place of those that it crosses the ones that they were
  /// cut into, and leaves are cut.
  void split(std::vector<int> nodes, const Plane& plane, std::vector<int>& lower,
             std::vector<int>& upper);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] std::vector<int> leaves() const;
  /// The leaves when there were this many for the first time; all, if there never were.
  [[nodiscard]] std::vector<int> leaves(std::size_t count) const;
  /// In place of these nodes the coarsest within this distance, and the leaves that are farther.
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
  struct Candidate {
    Plane plane;
    double score = std::numeric_limits<double>::infinity();
  };
  struct ReflexPlane {
    Plane plane;
    double weight;
  };
  [[nodiscard]] Side side_of(int node, const Plane& plane) const;
  /// Before the first cut: the planes that the solid itself suggests.
  void find_planes();
  void find_reflex_planes();
  [[nodiscard]] Node node_of(Piece&& piece) const;
  void add_leaf(Piece&& piece, int parent);
  std::vector<Candidate> candidates(const Node& node) const;
  /// Those of the piece's reflex edges that cut it, heaviest first.
  [[nodiscard]] std::vector<std::uint32_t> reflex_planes(const Node& node) const;
  /// A reflex edge's plane nearly the same, if there is one: scores, which the grid's spacing makes
  /// rough, do not tell a cut along a face from one just beside it.
  [[nodiscard]] Plane snapped(const Node& node, const Plane& plane) const;
  /// Appends the hull points of what is on either side. @return whether there is something on both.
  bool part(const Piece& piece, const Plane& plane, std::vector<Vec3>& lower,
            std::vector<Vec3>& upper) const;
  double score(const Node& node, const Plane& plane) const;
  /// The score after the best cut of each half besides.
  double look_ahead(const Node& node, const Plane& plane) const;
  /// Factor ≤ 1 of a cut's score, given the smaller half's volume and both.
  [[nodiscard]] double preference(double smaller, double volume) const;
  void cut(int leaf, const Plane& plane);
  void evaluate(const Node& node, std::vector<Candidate>& list) const;
  /// The best by `look_ahead` among the few that are best by themselves.
  [[nodiscard]] Candidate best_in_two(const Node& node, std::vector<Candidate> list) const;

  const SolidField& solid_;
  SearchOptions options_;
  double shift_;
  std::vector<Node> nodes_;
  std::size_t leaf_count_ = 0;
  bool planes_found_ = false;
  std::vector<Plane> mirrors_;
  std::vector<ReflexPlane> reflex_;                    // distinct
  std::vector<std::vector<std::uint32_t>> reflex_of_;  // triangle → reflex_ entries
};

}  // namespace kaboum::bcd
