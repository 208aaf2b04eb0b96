// Numbers of objects within their types, and of ground atoms and terms.
#include "task/numbering.h"

#include <kaboum/base/error.h>

#include <string>

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumNumbered = 200'000'000;   // ground atoms, or terms, of one task
constexpr std::size_t kMaximumPositions = 200'000'000;  // types times objects

std::vector<std::size_t> first_numbers(const Model& model, const std::vector<Symbol>& symbols) {
  std::vector<std::size_t> first = {0};
  for (const Symbol& s : symbols) {
    std::size_t count = s.numeric ? 0 : 1;
    for (const Index t : s.parameters) {
      count *= model.types[t].objects.size();
      if (count > kMaximumNumbered) break;
    }
    first.push_back(first.back() + count);
    if (first.back() > kMaximumNumbered)
      throw Error(ErrorCode::LimitReached, "'" + s.name +
                                               "' has too many ground instances (limit " +
                                               std::to_string(kMaximumNumbered) + ")");
  }
  return first;
}

}  // namespace

Numbering::Numbering(const Model& model) : model_(&model) {
  if (model.types.size() * model.objects.size() > kMaximumPositions)
    throw Error(ErrorCode::LimitReached, "too many types and constants");
  positions_.assign(model.types.size(), std::vector<Index>(model.objects.size(), kNone));
  for (std::size_t t = 0; t < model.types.size(); ++t)
    for (std::size_t i = 0; i < model.types[t].objects.size(); ++i)
      positions_[t][model.types[t].objects[i]] = static_cast<Index>(i);
  first_atom_ = first_numbers(model, model.predicates);
  first_term_ = first_numbers(model, model.functions);
}

}  // namespace kaboum::plan
