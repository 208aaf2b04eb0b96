// Conditions as disjunctions of what they need, for estimates.
#include "worlds/alternatives.h"

#include <algorithm>

namespace kaboum::plan::worlds {
namespace {

using Kind = Condition::Kind;
using Alternatives = std::vector<std::vector<Literal>>;
constexpr std::size_t kMost = 16;

void conjoin(Alternatives& all, const Alternatives& more) {
  if (all.size() * more.size() > kMost) return;
  Alternatives product;
  for (const auto& a : all)
    for (const auto& b : more) {
      product.push_back(a);
      product.back().insert(product.back().end(), b.begin(), b.end());
    }
  all = std::move(product);
}

}  // namespace

Alternatives alternatives(const WorldTask& task, const Condition& c) {
  if (c.kind == Kind::Is) return {{{c.variable, c.value}}};
  if (c.kind == Kind::IsNot && task.variables[c.variable].size == 2)
    return {{{c.variable, 1 - c.value}}};
  if (c.kind == Kind::False) return {};
  Alternatives all = {{}};
  if (c.kind == Kind::Or) {
    Alternatives some;
    for (const Condition& child : c.children)
      for (auto& n : alternatives(task, child)) some.push_back(std::move(n));
    return some.size() > kMost ? all : some;
  }
  if (c.kind == Kind::And)
    for (const Condition& child : c.children) conjoin(all, alternatives(task, child));
  return all;
}

Alternatives alternatives(const WorldTask& task, const std::vector<const Condition*>& all) {
  Alternatives made = {{}};
  for (const Condition* c : all) conjoin(made, alternatives(task, *c));
  for (auto& literals : made) {
    std::sort(literals.begin(), literals.end());
    literals.erase(std::unique(literals.begin(), literals.end()), literals.end());
  }
  return made;
}

}  // namespace kaboum::plan::worlds
