// Handles: words stored once, one after another, found by open addressing.
#include <kaboum/base/error.h>
#include <kaboum/plan/handles.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace kaboum::plan {
namespace {

/// Room for some more, by a quarter rather than by half of what there will be.
template <class T>
void make_room(std::vector<T>& list, std::size_t more) {
  const std::size_t wanted = list.size() + more;
  if (wanted > list.capacity()) list.reserve(std::max(wanted, list.size() + list.size() / 4 + 64));
}

}  // namespace

std::string_view HandleTable::word(std::uint32_t number) const {
  const std::uint32_t i = number - first_;
  const std::uint32_t begin = i == 0 ? 0 : ends_[i - 1];
  return {letters_.data() + begin, ends_[i] - begin};
}

/// Where the word is, or would be.
std::size_t HandleTable::slot(std::uint32_t type, std::string_view word) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t at = (std::hash<std::string_view>{}(word) + type * 0x9e3779b9U) & mask;
  while (table_[at] != kEmpty &&
         (types_[table_[at]] != type || this->word(first_ + table_[at]) != word))
    at = (at + 1) & mask;
  return at;
}

std::uint32_t HandleTable::intern(std::uint32_t type, std::string_view word) {
  std::size_t at = slot(type, word);
  if (table_[at] != kEmpty) return first_ + table_[at];
  if (type > std::numeric_limits<std::uint16_t>::max() || ends_.size() >= (1U << 30U) - first_ ||
      letters_.size() + word.size() >= kEmpty)
    throw Error(ErrorCode::LimitReached, "too many handles");
  if ((ends_.size() + 1) * 4 > table_.size() * 3) {
    std::vector<std::uint32_t> old(table_.size() * 2, kEmpty);
    old.swap(table_);
    for (const std::uint32_t i : old)
      if (i != kEmpty) table_[slot(types_[i], this->word(first_ + i))] = i;
    at = slot(type, word);
  }
  const auto number = static_cast<std::uint32_t>(ends_.size());
  make_room(letters_, word.size());
  make_room(ends_, 1);
  make_room(types_, 1);
  letters_.insert(letters_.end(), word.begin(), word.end());
  ends_.push_back(static_cast<std::uint32_t>(letters_.size()));
  types_.push_back(static_cast<std::uint16_t>(type));
  table_[at] = number;
  return first_ + number;
}

}  // namespace kaboum::plan
