#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "task/task.h"

namespace kaboum::plan {

/// Arguments of the atoms of a predicate, and where they are found by some of them.
class Relation {
 public:
  explicit Relation(std::size_t arity) : arity_(arity) {}

  [[nodiscard]] std::size_t arity() const { return arity_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Index* atom(std::size_t i) const { return arguments_.data() + i * arity_; }

  void add(const std::vector<Index>& arguments);

  /// Has atoms looked up by what they have at these positions (a bit each), now and when more come.
  /// @return a number for `find`
  Index lookup(std::uint64_t positions);
  /// Those that may have the same as `arguments` at the positions of a lookup; others may be among
  /// them. nullptr: none.
  [[nodiscard]] const std::vector<Index>* find(Index lookup, const Index* arguments) const;

 private:
  struct Lookup {
    std::uint64_t positions = 0;
    std::unordered_map<std::uint64_t, std::vector<Index>> found;  ///< by what is at these
  };
  std::size_t arity_, size_ = 0;
  std::vector<Index> arguments_;  ///< of one atom after the other
  std::vector<Lookup> lookups_;
};

}  // namespace kaboum::plan
