#pragma once

#include <cstddef>
#include <functional>
#include <vector>

// Where the nodes of a layered graph go. Internal to kaboum_plan.
namespace kaboum::plan {

/// A graph without cycles whose nodes stand in rows; every edge leads from a row to the next one.
struct LayeredGraph {
  struct Node {
    double width = 0;                       ///< room it needs, gap included
    std::vector<std::size_t> above, below;  ///< its neighbours in the rows beside its own
    double x = 0;                           ///< of its middle; place() sets it
  };
  std::vector<Node> nodes;
  std::vector<std::vector<std::size_t>> rows;  ///< from left to right; place() sorts them

  /// Adds a node to a row (made if need be). @return its number.
  std::size_t add(std::size_t row, double width);
  void connect(std::size_t upper, std::size_t lower);

  /// Sorts the rows so that few edges cross (barycentres, swept down and up [sugiyama1981]) and
  /// gives every node an x near its neighbours', such that no two of a row overlap. The smallest
  /// left side is at 0. @return the width of all.
  /// @param progress  called for every row; may be empty
  double place(const std::function<void()>& progress = {});
};

}  // namespace kaboum::plan
