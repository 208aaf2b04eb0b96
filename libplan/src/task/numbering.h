#pragma once

#include <kaboum/plan/model.h>

#include <cstddef>
#include <vector>

namespace kaboum::plan {

/// Numbers of ground atoms and function terms: those of one symbol follow each other, in the order
/// of its arguments.
class Numbering {
 public:
  /// @pre `model` outlives it. @throws Error{LimitReached} if they are too many.
  explicit Numbering(const Model& model);

  /// kNone: an argument is not of its type.
  [[nodiscard]] std::size_t atom(Index predicate, const Index* arguments) const {
    return number(model_->predicates[predicate], first_atom_[predicate], arguments);
  }
  [[nodiscard]] std::size_t term(Index function, const Index* arguments) const {
    return number(model_->functions[function], first_term_[function], arguments);
  }
  [[nodiscard]] std::size_t atoms() const { return first_atom_.back(); }
  [[nodiscard]] std::size_t terms() const { return first_term_.back(); }

  /// Of the atom with this number.
  [[nodiscard]] std::vector<Index> arguments(Index predicate, std::size_t atom) const {
    const std::vector<Index>& types = model_->predicates[predicate].parameters;
    std::vector<Index> out(types.size());
    std::size_t n = atom - first_atom_[predicate];
    for (std::size_t i = types.size(); i-- > 0;) {
      const std::vector<Index>& objects = model_->types[types[i]].objects;
      out[i] = objects[n % objects.size()];
      n /= objects.size();
    }
    return out;
  }

  // The first number of each symbol, and the number after the last.
  [[nodiscard]] const std::vector<std::size_t>& first_atom() const { return first_atom_; }
  [[nodiscard]] const std::vector<std::size_t>& first_term() const { return first_term_; }

  /// Position of an object among those of a type; kNone if it is not one of them.
  [[nodiscard]] Index position(Index type, Index object) const { return positions_[type][object]; }

 private:
  [[nodiscard]] std::size_t number(const Symbol& symbol, std::size_t first,
                                   const Index* arguments) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < symbol.parameters.size(); ++i) {
      const Index type = symbol.parameters[i];
      const Index p = positions_[type][arguments[i]];
      if (p == kNone) return kNone;
      n = n * model_->types[type].objects.size() + p;
    }
    return first + n;
  }

  const Model* model_;
  std::vector<std::vector<Index>> positions_;
  std::vector<std::size_t> first_atom_, first_term_;
};

}  // namespace kaboum::plan
