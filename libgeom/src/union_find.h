#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace kaboum::geom {

/// Disjoint sets of 0 … n − 1; a set is named by its smallest element.
class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }
  /// The set of each element, numbered by first element.
  std::vector<std::uint32_t> labels(std::uint32_t* count) {
    std::vector<std::uint32_t> label(parent_.size());
    std::uint32_t n = 0;
    for (std::uint32_t i = 0; i < label.size(); ++i) {
      const std::uint32_t root = find(i);
      label[i] = root == i ? n++ : label[root];
    }
    if (count != nullptr) *count = n;
    return label;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace kaboum::geom
