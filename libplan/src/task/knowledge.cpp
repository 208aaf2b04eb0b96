// Updates of a knowledge state and their inference; the databases are those of [petrick2002pks], as
// [gaschler2016] uses them. docs/planning/knowledge-states.md.
#include "task/knowledge.h"

#include <algorithm>
#include <bit>

namespace kaboum::plan {
namespace {

constexpr Word raw(AtomKnowledge k) { return static_cast<Word>(k); }

}  // namespace

bool Knowledge::excluded(Index fluent, Index value) const {
  const Fluent& f = layout_->fluents()[fluent];
  return f.exclusions != kNone && ((words_[f.exclusions + value / 64] >> (value % 64)) & 1U) != 0;
}

std::vector<Index> Knowledge::possible_values(Index fluent, std::size_t range_size) const {
  const Word v = value(fluent);
  if (v >= kFirstValue) return {static_cast<Index>(v - kFirstValue)};
  std::vector<Index> result;
  for (Index i = 0; i < range_size; ++i)
    if (!excluded(fluent, i)) result.push_back(i);
  return result;
}

void Knowledge::clear(const Group& group) {
  for (Index w = 0; w < group.words(); ++w) write(group.word + w, 0);
}

/// An undecided member changed, or may have: which of the others holds is no longer tied to it.
void Knowledge::drop_groups(const Fluent& f) {
  for (const auto& [g, bit] : f.groups) {
    const Group& group = layout_->groups()[g];
    if (group.contains(words_.data(), bit)) clear(group);
  }
}

bool Knowledge::apply(const Change& c) {
  using K = Change::Kind;
  if (c.kind == K::AddGroup) return learn_group(c.fluent);
  if (c.kind == K::DeleteGroup) {
    clear(layout_->groups()[c.fluent]);
    return true;
  }
  const Fluent& f = layout_->fluents()[c.fluent];
  const Word now = f.get(words_.data());
  // The atom takes this content by a change of the world.
  const auto become = [&](AtomKnowledge k) {
    set(c.fluent, raw(k));
    if (!f.groups.empty()) drop_groups(f);
  };
  const auto forget_value = [&] {
    set(c.fluent, kValueUnknown);
    clear_exclusions(f);
  };
  switch (c.kind) {
    case K::AddTrue:
      become(AtomKnowledge::True);
      break;
    case K::AddFalse:
      become(AtomKnowledge::False);
      break;
    case K::DeleteTrue:
      if (now != raw(AtomKnowledge::False)) become(AtomKnowledge::Unknown);
      break;
    case K::DeleteFalse:
      if (now != raw(AtomKnowledge::True)) become(AtomKnowledge::Unknown);
      break;
    case K::DeleteClosed:
      if (now != raw(AtomKnowledge::True)) become(AtomKnowledge::Unknown);
      break;
    case K::AddWhether:
    case K::AddClosed:
      if (now == raw(AtomKnowledge::Unknown)) {
        set(c.fluent, raw(AtomKnowledge::Whether));
        std::vector<Index> groups;
        for (const auto& [g, bit] : f.groups) groups.push_back(g);
        return propagate(std::move(groups));
      }
      break;
    case K::Forget:
      if (f.function) {
        forget_value();
      } else {
        become(AtomKnowledge::Unknown);
      }
      break;
    case K::AddValue:
      set(c.fluent, kFirstValue + c.value);
      clear_exclusions(f);
      break;
    case K::DeleteValue:
      if (now == kFirstValue + c.value || (now < kFirstValue && !excluded(c.fluent, c.value)))
        forget_value();
      break;
    case K::Exclude:
      if (now == kFirstValue + c.value) forget_value();
      return learn_not_value(c.fluent, c.value);
    case K::DeleteExclude:
      if (now != kFirstValue + c.value) forget_value();
      break;
    case K::AddSensed:
      if (now == kValueUnknown) set(c.fluent, kValueSensed);
      break;
    case K::AddOptions:
      if (now >= kFirstValue &&
          std::find(c.options.begin(), c.options.end(), now - kFirstValue) == c.options.end())
        forget_value();
      return learn_options(c.fluent, c.options);
    case K::AddGroup:
    case K::DeleteGroup:
      break;
  }
  return true;
}

bool Knowledge::learn_atom(Index fluent, bool truth) {
  const AtomKnowledge now = atom(fluent);
  const AtomKnowledge wanted = truth ? AtomKnowledge::True : AtomKnowledge::False;
  if (now == wanted) return true;
  if (now == AtomKnowledge::True || now == AtomKnowledge::False) return false;
  set(fluent, raw(wanted));
  const Fluent& f = layout_->fluents()[fluent];
  if (f.groups.empty()) return true;
  std::vector<Index> groups;
  for (const auto& [g, bit] : f.groups) groups.push_back(g);
  return propagate(std::move(groups));
}

bool Knowledge::learn_value(Index fluent, Index value) {
  const Word now = this->value(fluent);
  if (now >= kFirstValue) return now == kFirstValue + value;
  if (excluded(fluent, value)) return false;
  set(fluent, kFirstValue + value);
  clear_exclusions(layout_->fluents()[fluent]);
  return true;
}

bool Knowledge::learn_not_value(Index fluent, Index value) {
  const Fluent& f = layout_->fluents()[fluent];
  const Word now = f.get(words_.data());
  if (now >= kFirstValue) return now != kFirstValue + value;
  const Index word = f.exclusions + value / 64;
  write(word, words_[word] | (Word{1} << (value % 64)));
  // One value left: it is the value.
  const std::size_t range = layout_->range_size(f);
  std::size_t excluded_count = 0;
  for (Index i = 0; i < f.exclusion_words; ++i)
    excluded_count += static_cast<std::size_t>(std::popcount(words_[f.exclusions + i]));
  if (excluded_count + 1 < range) return true;
  if (excluded_count >= range) return false;
  return learn_value(fluent, possible_values(fluent, range).at(0));
}

bool Knowledge::learn_options(Index fluent, const std::vector<Index>& options) {
  const std::size_t range = layout_->range_size(layout_->fluents()[fluent]);
  for (Index v = 0; v < range; ++v)
    if (std::find(options.begin(), options.end(), v) == options.end() &&
        !learn_not_value(fluent, v))
      return false;
  return true;
}

bool Knowledge::learn_group(Index group) {
  const Group& g = layout_->groups()[group];
  std::size_t left = g.members.size();
  for (Index w = 0; w < g.words(); ++w, left -= std::min<std::size_t>(left, 64))
    write(g.word + w, left >= 64 ? ~Word{0} : (Word{1} << left) - 1);
  return propagate({group});
}

/// Unit propagation through the given groups and those it reaches.
bool Knowledge::propagate(std::vector<Index> groups) {
  while (!groups.empty()) {
    const Group& g = layout_->groups()[groups.back()];
    groups.pop_back();
    if (!propagate(g, groups)) return false;
  }
  return true;
}

/// Draws the conclusions of one group. `next` gets those that its decisions touch.
bool Knowledge::propagate(const Group& g, std::vector<Index>& next) {
  std::vector<Index> open;  // members
  Index holding = 0;
  for (Index i = 0; i < g.members.size(); ++i) {
    if (!g.contains(words_.data(), i)) continue;
    const AtomKnowledge k = atom(g.members[i]);
    if (k == AtomKnowledge::True) ++holding;
    if (k == AtomKnowledge::Unknown || k == AtomKnowledge::Whether) open.push_back(i);
  }
  bool empty = true;
  for (Index w = 0; w < g.words(); ++w) empty &= words_[g.word + w] == 0;
  if (empty) return true;
  if (holding > 1 || (holding == 0 && open.empty())) return false;
  const auto decide = [&](Index member, AtomKnowledge k) {
    set(g.members[member], raw(k));
    for (const auto& [other, bit] : layout_->fluents()[g.members[member]].groups)
      next.push_back(other);
  };
  if (holding == 1 || open.size() == 1) {
    for (const Index i : open) decide(i, holding == 1 ? AtomKnowledge::False : AtomKnowledge::True);
    clear(g);
    return true;
  }
  for (Index w = 0; w < g.words(); ++w) {
    Word members = 0;
    for (const Index i : open)
      if (i / 64 == w) members |= Word{1} << (i % 64);
    write(g.word + w, members);
  }
  // All but one will be known at run time: so will be the last.
  std::erase_if(open, [&](Index i) { return atom(g.members[i]) != AtomKnowledge::Unknown; });
  if (open.size() == 1) decide(open[0], AtomKnowledge::Whether);
  return true;
}

}  // namespace kaboum::plan
