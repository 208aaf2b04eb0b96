// The layout of states: fields of fluents packed into words, bit sets of excluded values, Kx
// entries.
#include "task/layout.h"

#include <algorithm>
#include <bit>

namespace kaboum::plan {

Layout::Layout(const Model& model, Limits& limits) : model_(model), numbering_(model) {
  limits.hold(numbering_.atoms() * (sizeof(char) + sizeof(AtomKnowledge) + sizeof(Index)) +
              numbering_.terms() * (sizeof(char) + 2 * sizeof(Index)));
  ChangeAnalysis analysis(model, numbering_, limits);
  atom_fluents_.assign(numbering_.atoms(), kNone);
  term_fluents_.assign(numbering_.terms(), kNone);
  make_fluents(model.functions, true, analysis.term_changes, term_fluents_);
  make_fluents(model.predicates, false, analysis.atom_changes, atom_fluents_);
  atom_constants_ = std::move(analysis.atom_constants);
  term_constants_ = std::move(analysis.term_constants);
  sensing_ = analysis.sensing;
  make_groups(analysis.group_atoms);
  assign_words(analysis.function_exclusions);
  limits.work(fluents_.size() * (sizeof(Fluent) + 32) +
              model.types.size() * model.objects.size() * sizeof(Index));
}

/// Fluents of the instances that change, in order of declaration and arguments.
void Layout::make_fluents(const std::vector<Symbol>& symbols, bool function,
                          const std::vector<char>& changes, std::vector<Index>& fluent_of) {
  for (Index s = 0; s < symbols.size(); ++s) {
    if (symbols[s].numeric) continue;
    const auto& first = function ? numbering_.first_term() : numbering_.first_atom();
    const auto at = [&](Index symbol) {
      return changes.begin() + static_cast<std::ptrdiff_t>(first[symbol]);
    };
    // Of what never changes there may be millions.
    if (std::find(at(s), at(s + 1), 1) == at(s + 1)) continue;
    std::vector<Index> arguments(symbols[s].parameters.size());
    const auto visit = [&](const auto& self, std::size_t i) -> void {
      if (i == arguments.size()) {
        const std::size_t n =
            function ? numbering_.term(s, arguments.data()) : numbering_.atom(s, arguments.data());
        if (!changes[n]) return;
        Fluent f;
        f.function = function;
        f.symbol = s;
        f.arguments = arguments;
        f.range = function ? symbols[s].range : kNone;
        f.handle = function && model_.types[f.range].handle;
        fluent_of[n] = static_cast<Index>(fluents_.size());
        fluents_.push_back(std::move(f));
        return;
      }
      for (const Index o : model_.types[symbols[s].parameters[i]].objects) {
        arguments[i] = o;
        self(self, i + 1);
      }
    };
    visit(visit, 0);
  }
}

void Layout::make_groups(const std::vector<std::vector<ChangeAnalysis::Atom>>& entries) {
  for (const auto& atoms : entries) {
    Group g;
    for (const auto& [predicate, arguments] : atoms)
      g.members.push_back(atom(predicate, arguments.data()).fluent);
    std::sort(g.members.begin(), g.members.end());
    g.members.erase(std::unique(g.members.begin(), g.members.end()), g.members.end());
    const auto index = static_cast<Index>(groups_.size());
    if (group_by_members_.emplace(g.members, index).second) groups_.push_back(std::move(g));
  }
}

/// First fit in order of declaration keeps what changes together close; widths differ little.
struct Layout::BitAllocator {
  static constexpr unsigned kWordBits = 64;
  static constexpr std::size_t kOpenWords = 8;  ///< words that are looked at for room

  struct Bits {
    Index word;
    unsigned shift;
  };
  Index& words;
  std::vector<Bits> open;  ///< words with the number of bits in use

  Bits take(unsigned bits) {
    for (Bits& o : open)
      if (o.shift + bits <= kWordBits) {
        const Bits at = o;
        o.shift += bits;
        return at;
      }
    open.push_back({words++, bits});
    if (open.size() > kOpenWords) open.erase(open.begin());
    return {words - 1, 0};
  }
};

void Layout::assign_words(const std::vector<char>& function_exclusions) {
  BitAllocator allocator{words_, {}};
  for (Fluent& f : fluents_) {
    const unsigned bits =
        f.handle     ? kHandleBits
        : f.function ? static_cast<unsigned>(std::bit_width(range_size(f) + kFirstValue - 1))
                     : 2;
    const BitAllocator::Bits at = allocator.take(bits);
    f.word = at.word;
    f.shift = at.shift;
    f.mask = ((Word{1} << bits) - 1) << f.shift;
  }
  for (Fluent& f : fluents_) {
    if (!f.function || !function_exclusions[f.symbol]) continue;
    f.exclusions = words_;
    f.exclusion_words = static_cast<Index>((range_size(f) + 63) / 64);
    words_ += f.exclusion_words;
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].word = words_;
    words_ += groups_[g].words();
    for (std::size_t i = 0; i < groups_[g].members.size(); ++i)
      fluents_[groups_[g].members[i]].groups.emplace_back(static_cast<Index>(g),
                                                          static_cast<Index>(i));
  }
  if (words_ == 0) words_ = 1;
}

Layout::Field Layout::atom(Index predicate, const Index* arguments) const {
  Field field;
  const std::size_t n = numbering_.atom(predicate, arguments);
  if (n == kNone) {
    field.exists = false;
    return field;
  }
  field.fluent = atom_fluents_[n];
  field.atom = atom_constants_[n];
  return field;
}

Layout::Field Layout::term(Index function, const Index* arguments) const {
  Field field;
  const std::size_t n = numbering_.term(function, arguments);
  if (n == kNone) {
    field.exists = false;
    return field;
  }
  field.fluent = term_fluents_[n];
  field.value = term_constants_[n];
  return field;
}

Index Layout::sensed_tie(Index fluent, const Word* state) const {
  std::vector<Index> todo = {fluent};
  std::vector<Index> seen = {fluent};
  while (!todo.empty()) {
    const Fluent& f = fluents_[todo.back()];
    todo.pop_back();
    for (const auto& [g, bit] : f.groups) {
      const Group& group = groups_[g];
      if (!group.contains(state, bit)) continue;
      for (std::size_t i = 0; i < group.members.size(); ++i) {
        const Index m = group.members[i];
        if (!group.contains(state, static_cast<Index>(i)) ||
            std::find(seen.begin(), seen.end(), m) != seen.end())
          continue;
        if (fluents_[m].get(state) == static_cast<Word>(AtomKnowledge::Whether)) return m;
        seen.push_back(m);
        todo.push_back(m);
      }
    }
  }
  return kNone;
}

Index Layout::group(std::vector<Index> members) const {
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  const auto found = group_by_members_.find(members);
  return found == group_by_members_.end() ? kNone : found->second;
}

}  // namespace kaboum::plan
