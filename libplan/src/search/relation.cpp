// Atoms of a predicate, found by some of their arguments.
#include "search/relation.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

std::uint64_t key_of(const Index* arguments, std::uint64_t positions) {
  std::uint64_t h = 0;
  for (std::size_t i = 0; positions != 0; ++i, positions >>= 1U)
    if ((positions & 1U) != 0) h = (h ^ arguments[i]) * 0x9e3779b97f4a7c15ULL ^ (h >> 29U);
  return h;
}

}  // namespace

void Relation::add(const std::vector<Index>& arguments) {
  for (Lookup& l : lookups_)
    l.found[key_of(arguments.data(), l.positions)].push_back(static_cast<Index>(size_));
  arguments_.insert(arguments_.end(), arguments.begin(), arguments.end());
  ++size_;
}

Index Relation::lookup(std::uint64_t positions) {
  const auto known = std::ranges::find(lookups_, positions, &Lookup::positions);
  if (known != lookups_.end()) return static_cast<Index>(known - lookups_.begin());
  Lookup& made = lookups_.emplace_back();
  made.positions = positions;
  for (std::size_t i = 0; i < size_; ++i)
    made.found[key_of(atom(i), positions)].push_back(static_cast<Index>(i));
  return static_cast<Index>(lookups_.size() - 1);
}

const std::vector<Index>* Relation::find(Index lookup, const Index* arguments) const {
  const Lookup& l = lookups_[lookup];
  const auto found = l.found.find(key_of(arguments, l.positions));
  return found == l.found.end() ? nullptr : &found->second;
}

}  // namespace kaboum::plan
