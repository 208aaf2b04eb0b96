#pragma once

#include <kaboum/plan/model.h>

#include <set>
#include <utility>
#include <vector>

namespace kaboum::plan {

/// All worlds, as values by column, that meet some constraints. Of the validator.
class WorldEnumeration {
 public:
  using World = std::vector<Index>;

  /// At least one of the literals holds, or exactly one.
  struct Constraint {
    bool exactly_one = false;
    struct Literal {
      std::size_t column;
      Index value;
      bool negated;
    };
    std::vector<Literal> literals;
  };

  void add_column(bool atom, std::vector<Index> range) {
    atoms_.push_back(atom);
    ranges_.push_back(std::move(range));
  }
  void add(Constraint constraint) { constraints_.push_back(std::move(constraint)); }

  /// Adds all worlds to `out` that have the values of `w`, where those are not kNone.
  /// @return false: there are more than `most`.
  bool enumerate(World& w, std::size_t most, std::set<World>& out) const;

 private:
  bool conclude(World& w, std::vector<std::size_t>& concluded) const;

  std::vector<bool> atoms_;                 ///< by column
  std::vector<std::vector<Index>> ranges_;  ///< by column
  std::vector<Constraint> constraints_;
};

}  // namespace kaboum::plan
