// A hash table of states with open addressing.
#include "search/state_store.h"

#include "task/knowledge.h"

namespace kaboum::plan {

void StateStore::grow() {
  std::vector<Index> larger(table_.size() * 2, kNone);
  for (Index i = 0; i < size_; ++i) {
    std::size_t slot =
        Knowledge::hash_of((*this)[i], static_cast<Index>(words_)) & (larger.size() - 1);
    while (larger[slot] != kNone) slot = (slot + 1) & (larger.size() - 1);
    larger[slot] = i;
  }
  table_ = std::move(larger);
}

}  // namespace kaboum::plan
