#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "appraise.h"
#include "piece.h"

namespace kaboum::bcd {

struct SearchOptions {
  int offsets = 7;  ///< per direction
  int reflex_planes = 10;
  int refinements = 2;  ///< halvings of the best plane's offset
};

/// Binary tree of cuts. Leaves that are still open to cutting hold their piece.
class CutTree {
 public:
  struct Node {
    Piece piece;             ///< empty once cut
    std::vector<Vec3> hull;  ///< vertices of the hull
    Appraisal appraisal;
    int parent = -1, lower = -1, upper = -1;
    Plane plane;
    bool stuck = false;  ///< no plane makes it better
  };

  /// @param safety  multiplies the overlap of neighbouring pieces.
  CutTree(const Solid& solid, const SearchOptions& options, double safety = 1);

  /// Cuts the leaf with the largest distance. @return false when no leaf can be cut.
  bool cut_worst();
  /// Cuts this leaf. @return false when no plane cuts it.
  bool cut(int leaf);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] std::vector<int> leaves() const;
  /// Appends the leaves that a node was cut into, itself when it was not.
  void leaves_below(int node, std::vector<int>& out) const;
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
  void find_reflex_planes();
  void add_leaf(Piece&& piece, int parent);
  std::vector<Candidate> candidates(const Node& node) const;
  double score(const Node& node, const Plane& plane) const;
  void evaluate(const Node& node, std::vector<Candidate>& list) const;

  const Solid& solid_;
  SearchOptions options_;
  double shift_;
  std::vector<Node> nodes_;
  std::size_t leaf_count_ = 0;
  std::vector<ReflexPlane> reflex_;                    // distinct
  std::vector<std::vector<std::uint32_t>> reflex_of_;  // triangle → reflex_ entries
};

/// Bodies as unions of leaves, one hull round each.
struct Body {
  std::vector<Vec3> hull;   ///< vertices
  std::vector<int> leaves;  ///< of the tree
  Appraisal appraisal;
  Box3 box;
};

Body body_of(const CutTree& tree, int leaf);
/// One body round all of them.
Body union_of(const CutTree& tree, const Solid& solid, const std::vector<int>& leaves);
/// Whether the bodies' boxes are near each other.
bool touch(const Body& a, const Body& b, const Solid& solid);

/// Merges neighbours, cheapest first, while the merged distance stays ≤ `epsilon` and there are
/// more than `target` bodies. The cost is that distance, and `bulk` times the side of a cube of
/// the volume added.
std::vector<Body> merge(std::vector<Body> bodies, const Solid& solid, std::size_t target,
                        double epsilon, double bulk = 0.05);

}  // namespace kaboum::bcd
