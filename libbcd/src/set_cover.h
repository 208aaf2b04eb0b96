#pragma once

#include <kaboum/base/random.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kaboum::bcd {

/// Few of given sets whose union has all points: a local search with weights. A chosen set that is
/// the only one to hold the least weight of points is dropped, one that holds most weight of what
/// is free is taken; points that stay free gain weight. Source: [gao2015].
class SetCover {
 public:
  /// @param sets  of each its points, which are below `points`
  SetCover(std::size_t points, std::vector<std::vector<std::uint32_t>> sets);

  /// A choice by greatest gain, and then the best after so many steps.
  /// @param enough  ends once so many sets or fewer hold all
  /// @return indices of sets, in order; empty if all of them do not hold all points
  std::vector<std::uint32_t> search(std::size_t steps, std::size_t enough = 0);

 private:
  void take(std::uint32_t set);
  void drop(std::uint32_t set);
  [[nodiscard]] bool has(std::uint32_t set, std::uint32_t point) const {
    return (bits_[set * words_ + point / 64] >> (point % 64) & 1U) != 0;
  }
  [[nodiscard]] double gain(std::uint32_t set) const;
  [[nodiscard]] double loss(std::uint32_t set) const;
  void choose_greedily();
  [[nodiscard]] std::size_t cheapest(std::uint32_t kept) const;

  std::vector<std::vector<std::uint32_t>> sets_, of_point_;
  std::size_t words_;                          // of a set in `bits_`
  std::vector<std::uint64_t> bits_;            // by set and point: whether it has it
  std::vector<std::uint32_t> chosen_, times_;  // times that a point is held
  std::vector<std::uint32_t> free_, place_;    // points that are not held, and where they are there
  std::vector<double> weight_;
  std::vector<std::size_t> changed_;  // step of a set's last change
  std::vector<char> may_be_taken_, is_chosen_;
  Random random_{1};
};

}  // namespace kaboum::bcd
