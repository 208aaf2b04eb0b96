// Interned worlds and sets of worlds; the initial ones by unit propagation and case distinction.
#include "worlds/world_sets.h"

#include <algorithm>
#include <bit>

#include "task/knowledge.h"

namespace kaboum::plan::worlds {

Index WorldSets::world(const Word* contents) {
  return worlds_.insert(contents, Knowledge::hash_of(contents, words_), kNone, 0).first;
}

std::uint64_t WorldSets::hash(const Index* worlds, std::size_t count) const {
  std::uint64_t h = count;
  for (std::size_t i = 0; i < count; ++i) h = word_hash(static_cast<Index>(i & 7U), h ^ worlds[i]);
  return h;
}

Index WorldSets::set(std::vector<Index>& worlds) {
  std::sort(worlds.begin(), worlds.end());
  worlds.erase(std::unique(worlds.begin(), worlds.end()), worlds.end());
  if ((begins_.size() + 1) * 4 > table_.size() * 3) grow();
  std::size_t slot = hash(worlds.data(), worlds.size()) & (table_.size() - 1);
  for (; table_[slot] != kNone; slot = (slot + 1) & (table_.size() - 1)) {
    const Members m = members(table_[slot]);
    if (m.count == worlds.size() && std::equal(worlds.begin(), worlds.end(), m.begin()))
      return table_[slot];
  }
  const auto number = static_cast<Index>(begins_.size() - 1);
  table_[slot] = number;
  elements_.insert(elements_.end(), worlds.begin(), worlds.end());
  begins_.push_back(elements_.size());
  const std::size_t at = bits_.size();
  bits_.resize(at + 2 * static_cast<std::size_t>(words_), 0);
  std::fill_n(bits_.begin() + static_cast<long>(at), words_, ~Word{0});
  for (const Index w : worlds)
    for (Index i = 0; i < words_; ++i) {
      bits_[at + i] &= contents(w)[i];
      bits_[at + words_ + i] |= contents(w)[i];
    }
  return number;
}

void WorldSets::grow() {
  std::vector<Index> table(table_.size() * 2, kNone);
  for (std::size_t s = 0; s + 1 < begins_.size(); ++s) {
    const Members m = members(static_cast<Index>(s));
    std::size_t slot = hash(m.first, m.count) & (table.size() - 1);
    while (table[slot] != kNone) slot = (slot + 1) & (table.size() - 1);
    table[slot] = static_cast<Index>(s);
  }
  table_ = std::move(table);
}

namespace {

/// Enumerates the assignments of a component's variables that meet its constraints.
class Models {
 public:
  Models(const WorldTask& task, Index component, std::size_t most, WorldSets& sets, Limits& limits)
      : task_(task),
        own_(task.components[component].variables),
        most_(most),
        sets_(sets),
        limits_(limits),
        value_(task.variables.size(), kNone),
        ruled_out_(task.variables.size()),
        touched_by_(task.variables.size()) {
    for (Index v = 0; v < value_.size(); ++v) value_[v] = task.variables[v].initial;
    for (const Index v : own_) ruled_out_[v].assign(task.variables[v].size, 0);
    for (Index c = 0; c < task.constraints.size(); ++c) {
      // A variable whose value is known at the start ties nothing.
      bool own = false;
      for (const auto& l : task.constraints[c].literals)
        own |= task.variables[l.variable].initial == kNone &&
               task.variables[l.variable].component == component;
      if (!own) continue;
      constraints_.push_back(c);
      for (const auto& l : task.constraints[c].literals) touched_by_[l.variable].push_back(c);
    }
  }

  std::optional<std::vector<Index>> run() {
    std::vector<Index> all = constraints_;
    if (propagate(std::move(all))) branch(0);
    if (too_many_) return std::nullopt;
    return std::move(found_);
  }

 private:
  enum class Truth : std::uint8_t { No, Yes, Open };

  [[nodiscard]] Truth truth(const Constraint::Literal& l) const {
    const Index v = l.variable;
    if (value_[v] != kNone) return (value_[v] == l.value) != l.negated ? Truth::Yes : Truth::No;
    if (ruled_out_[v].at(l.value) != 0) return l.negated ? Truth::Yes : Truth::No;
    return Truth::Open;
  }

  /// @return false if that contradicts what is assumed.
  bool assume(const Constraint::Literal& l, bool holds, std::vector<Index>& next) {
    if (const Truth t = truth(l); t != Truth::Open) return (t == Truth::Yes) == holds;
    const Index v = l.variable;
    if (l.negated != holds) {
      value_[v] = l.value;
      trail_.push_back({v, kNone});
    } else {
      ruled_out_[v][l.value] = 1;
      trail_.push_back({v, l.value});
      const auto left = std::count(ruled_out_[v].begin(), ruled_out_[v].end(), 0);
      if (left == 0) return false;
      if (left == 1) {
        value_[v] = static_cast<Index>(std::find(ruled_out_[v].begin(), ruled_out_[v].end(), 0) -
                                       ruled_out_[v].begin());
        trail_.push_back({v, kNone});
      }
    }
    next.insert(next.end(), touched_by_[v].begin(), touched_by_[v].end());
    return true;
  }

  bool propagate(std::vector<Index> todo) {
    while (!todo.empty()) {
      const Constraint& c = task_.constraints[todo.back()];
      todo.pop_back();
      std::size_t holding = 0;
      std::size_t open = 0;
      const Constraint::Literal* last = nullptr;
      for (const Constraint::Literal& l : c.literals) {
        const Truth t = truth(l);
        holding += t == Truth::Yes ? 1 : 0;
        if (t != Truth::Open) continue;
        ++open;
        last = &l;
      }
      if (c.exactly_one && holding > 1) return false;
      if (holding == 0 && open == 0) return false;
      if (holding == 0 && open == 1 && !assume(*last, true, todo)) return false;
      if (c.exactly_one && holding == 1)
        for (const Constraint::Literal& l : c.literals)
          if (truth(l) == Truth::Open && !assume(l, false, todo)) return false;
    }
    return true;
  }

  void undo(std::size_t mark) {
    for (; trail_.size() > mark; trail_.pop_back()) {
      const auto [v, value] = trail_.back();
      if (value == kNone)
        value_[v] = kNone;
      else
        ruled_out_[v][value] = 0;
    }
  }

  void branch(std::size_t n) {
    if (too_many_) return;
    limits_.work();
    while (n < own_.size() && value_[own_[n]] != kNone) ++n;
    if (n == own_.size()) {
      std::vector<Word> world(sets_.words(), 0);
      for (const Index v : own_) task_.variables[v].set(world.data(), value_[v]);
      found_.push_back(sets_.world(world.data()));
      too_many_ = found_.size() > most_;
      return;
    }
    const Index v = own_[n];
    for (Index value = 0; value < task_.variables[v].size; ++value) {
      if (ruled_out_[v][value] != 0) continue;
      const std::size_t mark = trail_.size();
      std::vector<Index> todo;
      if (assume({v, value, false}, true, todo) && propagate(std::move(todo))) branch(n + 1);
      undo(mark);
    }
  }

  const WorldTask& task_;
  const std::vector<Index>& own_;
  std::size_t most_;
  WorldSets& sets_;
  Limits& limits_;
  std::vector<Index> value_;
  std::vector<std::vector<char>> ruled_out_;
  std::vector<std::vector<Index>> touched_by_;
  std::vector<Index> constraints_;
  std::vector<std::pair<Index, Index>> trail_;  ///< variable, and the value ruled out (kNone: set)
  std::vector<Index> found_;
  bool too_many_ = false;
};

}  // namespace

bool is_contradicted(const WorldTask& task, const Constraint& c) {
  std::size_t holding = 0;
  for (const Constraint::Literal& l : c.literals) {
    const Index value = task.variables[l.variable].initial;
    if (value == kNone) return false;
    holding += (value == l.value) != l.negated ? 1 : 0;
  }
  return holding == 0 || (c.exactly_one && holding > 1);
}

std::optional<std::vector<Index>> initial_worlds(const WorldTask& task, Index component,
                                                 std::size_t most, WorldSets& sets,
                                                 Limits& limits) {
  auto found = Models(task, component, most, sets, limits).run();
  if (found && found->empty())
    throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
  return found;
}

}  // namespace kaboum::plan::worlds
