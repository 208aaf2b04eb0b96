#pragma once

#include "search_state.h"

namespace kaboum::bcd {

/// Moves between bodies that lower the largest distance of all: pieces of one go to another, two
/// are split anew, one is split and others are merged.
class LocalSearch {
 public:
  explicit LocalSearch(SearchState& state) : state_(state) {}

  /// Improves the worst body, again and again, while that helps. There are at most `target` bodies
  /// wherever two are merged for it.
  /// @param chains  where the worst cannot be helped, those nearly as far may be.
  void refine(std::vector<Body>& bodies, std::size_t target, bool chains = true);

  /// Two or more bodies in place of one, merged as far as `epsilon` allows; with `all` all its
  /// pieces. None where it cannot be split.
  std::vector<Body> split_body(const Body& body, double epsilon, bool all = false);

 private:
  bool move_piece(std::vector<Body>& bodies, std::size_t from) const;
  bool resplit(std::vector<Body>& bodies, std::size_t from, double gain = kResplitGain);
  bool relax_chain(std::vector<Body>& bodies);
  bool split_and_merge(std::vector<Body>& bodies, std::size_t which, const std::vector<Body>& parts,
                       std::size_t target);

  SearchState& state_;
};

}  // namespace kaboum::bcd
