#include "task/layout.h"

#include <kaboum/geom/error.h>

#include <algorithm>
#include <bit>

#include "task/bindings.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumNumbered = 20'000'000;  // ground atoms and terms of one task
constexpr std::size_t kMaximumPositions = 200'000'000;
constexpr std::size_t kMaximumVisits = 2'000'000;  // bindings looked at to find what can change

template <class Visit>
void for_each_update(const std::vector<Effect>& effects, const Visit& visit) {
  for (const Effect& e : effects) {
    if (e.kind == Effect::Kind::Update) {
      visit(e.update);
    } else {
      for_each_update(e.children, visit);
    }
  }
}

}  // namespace

/// Finds what can change, then assigns fields.
struct Layout::Builder {
  Layout& layout;
  const Model& model;
  Limits& limits;
  std::vector<char> atom_changes, term_changes;  ///< by number
  std::vector<std::vector<std::pair<Index, std::vector<Index>>>> group_atoms;
  std::size_t visits = 0;

  void number_all() {
    if (model.types.size() * model.objects.size() > kMaximumPositions)
      throw Error(ErrorCode::LimitReached, "too many types and constants");
    layout.positions_.assign(model.types.size(), std::vector<Index>(model.objects.size(), kNone));
    for (std::size_t t = 0; t < model.types.size(); ++t)
      for (std::size_t i = 0; i < model.types[t].objects.size(); ++i)
        layout.positions_[t][model.types[t].objects[i]] = static_cast<Index>(i);
    std::size_t atoms = 0;
    std::size_t terms = 0;
    const auto assign = [&](const std::vector<Symbol>& symbols, std::vector<Block>& blocks,
                            std::size_t& next) {
      for (const Symbol& s : symbols) {
        blocks.push_back({next, false, false});
        std::size_t count = s.numeric ? 0 : 1;
        for (const Index t : s.parameters) {
          count *= model.types[t].objects.size();
          if (count > kMaximumNumbered) break;
        }
        next += count;
        if (next > kMaximumNumbered)
          throw Error(ErrorCode::LimitReached, "'" + s.name +
                                                   "' has too many ground instances (limit " +
                                                   std::to_string(kMaximumNumbered) + ")");
      }
    };
    assign(model.predicates, layout.predicates_, atoms);
    assign(model.functions, layout.functions_, terms);
    atom_changes.assign(atoms, 0);
    term_changes.assign(terms, 0);
    layout.atom_fluents_.assign(atoms, kNone);
    layout.term_fluents_.assign(terms, kNone);
    layout.atom_constants_.assign(atoms, AtomKnowledge::Unknown);
    layout.term_constants_.assign(terms, kNone);
  }

  /// Which symbols some update names; whether anything is sensed.
  void scan(const Update& u, bool initial) {
    using D = Update::Database;
    if (u.database == D::Kw || u.database == D::Kv) layout.sensing_ |= u.add;
    if (u.database == D::Lcw && u.add && !initial) layout.sensing_ = true;
    for (const Update::Literal& l : u.literals) {
      if (l.function && (u.database == D::Kx || (u.database == D::Kf && l.negated)))
        layout.functions_[l.symbol].exclusions = true;
      if (!initial) (l.function ? layout.functions_ : layout.predicates_)[l.symbol].changes = true;
    }
  }

  void mark(const Update::Literal& l, const Index* slots) {
    std::vector<Index> arguments;
    for (const Argument& a : l.arguments) arguments.push_back(value_of(a, slots));
    const Symbol& s = (l.function ? model.functions : model.predicates)[l.symbol];
    const std::size_t n = layout.number(
        s, (l.function ? layout.functions_ : layout.predicates_)[l.symbol], arguments.data());
    if (n != kNone) (l.function ? term_changes : atom_changes)[n] = 1;
  }

  void mark_update(const Update& u, const Index* slots) {
    for (const Update::Literal& l : u.literals) mark(l, slots);
    if (u.database != Update::Database::Kx || u.literals[0].function) return;
    std::vector<std::pair<Index, std::vector<Index>>> atoms;
    for (const Update::Literal& l : u.literals) {
      std::vector<Index> arguments;
      for (const Argument& a : l.arguments) arguments.push_back(value_of(a, slots));
      atoms.emplace_back(l.symbol, std::move(arguments));
    }
    group_atoms.push_back(std::move(atoms));
    if (group_atoms.size() > 100'000)
      throw Error(ErrorCode::LimitReached, "too many entries of Kx");
  }

  void mark_effects(const std::vector<Effect>& effects, std::vector<Index>& slots) {
    for (const Effect& e : effects) {
      limits.work();
      if (++visits > kMaximumVisits) return;
      if (e.kind == Effect::Kind::Update) {
        mark_update(e.update, slots.data());
      } else if (e.kind == Effect::Kind::When) {
        mark_effects(e.children, slots);
      } else {
        for (const Index o : model.types[e.type].objects) {
          slots[e.slot] = o;
          mark_effects(e.children, slots);
        }
      }
    }
  }

  // A conjunct that only constant knowledge decides.
  [[nodiscard]] bool is_constant(const Query& q) const {
    switch (q.kind) {
      case Query::Kind::Known:
      case Query::Kind::KnowWhether:
        return !layout.predicates_[q.symbol].changes;
      case Query::Kind::Not:
        return is_constant(q.children[0]);
      case Query::Kind::Same:
        return true;
      default:
        return false;
    }
  }
  /// Certainly false of the constant knowledge that initial Kf entries give. Atoms in Kw or Kx are
  /// not constant: unknown is then no proof, so symbols with such entries are skipped.
  [[nodiscard]] bool refuted(const Query& q, const Index* slots) const {
    if (q.kind == Query::Kind::Not) {
      const Query& c = q.children[0];
      if (c.kind == Query::Kind::Same)
        return value_of(c.arguments[0], slots) == value_of(c.arguments[1], slots);
      if (c.kind != Query::Kind::Known || open_symbols[c.symbol]) return false;
      return holds(c, slots);
    }
    if (q.kind == Query::Kind::Same)
      return value_of(q.arguments[0], slots) != value_of(q.arguments[1], slots);
    if (q.kind != Query::Kind::Known || open_symbols[q.symbol]) return false;
    return !holds(q, slots);
  }
  [[nodiscard]] bool holds(const Query& q, const Index* slots) const {
    std::vector<Index> arguments;
    for (const Argument& a : q.arguments) arguments.push_back(value_of(a, slots));
    const std::size_t n =
        layout.number(model.predicates[q.symbol], layout.predicates_[q.symbol], arguments.data());
    if (n == kNone) return false;
    return layout.atom_constants_[n] == (q.negated ? AtomKnowledge::False : AtomKnowledge::True);
  }
  std::vector<char> open_symbols;  ///< predicates with initial Kw or Kx entries

  void mark_action(const Action& a) {
    struct Check {
      const Query* query;
      Index depth;
    };
    std::vector<Check> checks;
    for (const Query* q : conjuncts(a.precondition)) {
      if (!is_constant(*q)) continue;
      const auto free = free_slots(*q);
      checks.push_back({q, free.empty() ? 0 : free.back() + 1});
    }
    std::vector<Index> slots(a.slots, 0);
    const auto visit = [&](const auto& self, Index depth) -> void {
      for (const Check& c : checks)
        if (c.depth == depth && refuted(*c.query, slots.data())) return;
      if (depth == a.parameters.size()) {
        mark_effects(a.effects, slots);
        return;
      }
      for (const Index o : model.types[a.parameters[depth].type].objects) {
        limits.work();
        if (++visits > kMaximumVisits) return;
        slots[depth] = o;
        self(self, depth + 1);
      }
    };
    visit(visit, 0);
  }

  void initial_constants() {
    for (const Update& u : model.initial) {
      scan(u, true);
      if (u.database == Update::Database::Kx || u.database == Update::Database::Kw)
        for (const Update::Literal& l : u.literals)
          if (!l.function) open_symbols[l.symbol] = 1;
      if (u.database == Update::Database::Lcw) continue;
      const Update::Literal& l = u.literals[0];
      std::vector<Index> arguments;
      for (const Argument& a : l.arguments) arguments.push_back(a.index);
      if (u.database != Update::Database::Kf || (l.function && l.negated)) {
        mark_update(u, nullptr);  // disjunctive or sensed knowledge, or f != c: not constant
        continue;
      }
      const Symbol& s = (l.function ? model.functions : model.predicates)[l.symbol];
      const std::size_t n = layout.number(
          s, (l.function ? layout.functions_ : layout.predicates_)[l.symbol], arguments.data());
      ensure(n != kNone, "initial knowledge outside its types");
      if (l.function) {
        layout.term_constants_[n] = l.value->index;
      } else {
        layout.atom_constants_[n] = l.negated ? AtomKnowledge::False : AtomKnowledge::True;
      }
    }
    for (const Update& u : model.initial) {
      if (u.database != Update::Database::Lcw) continue;
      std::vector<Index> arguments;
      for (const Argument& a : u.literals[0].arguments) arguments.push_back(a.index);
      const Index p = u.literals[0].symbol;
      const std::size_t n =
          layout.number(model.predicates[p], layout.predicates_[p], arguments.data());
      if (layout.atom_constants_[n] == AtomKnowledge::Unknown)
        layout.atom_constants_[n] = AtomKnowledge::False;
    }
  }

  void place_fields() {
    struct Open {
      Index word;
      unsigned used;
    };
    std::vector<Fluent>& fluents = layout.fluents_;
    // First fit in order of declaration keeps what changes together close; widths differ little.
    std::vector<Open> open;
    const auto place = [&](unsigned bits) {
      for (Open& o : open)
        if (o.used + bits <= 64) {
          const Open at = o;
          o.used += bits;
          return at;
        }
      open.push_back({layout.words_++, bits});
      if (open.size() > 8) open.erase(open.begin());
      return Open{layout.words_ - 1, 0};
    };
    for (Fluent& f : fluents) {
      unsigned bits = 2;
      if (f.function)
        bits = static_cast<unsigned>(
            std::bit_width(model.types[f.range].objects.size() + kFirstValue - 1));
      const Open at = place(bits);
      f.word = at.word;
      f.shift = at.used;
      f.mask = ((Word{1} << bits) - 1) << f.shift;
    }
    for (Fluent& f : fluents) {
      if (!f.function || !layout.functions_[f.symbol].exclusions) continue;
      f.exclusions = layout.words_;
      f.exclusion_words = static_cast<Index>((model.types[f.range].objects.size() + 63) / 64);
      layout.words_ += f.exclusion_words;
    }
    for (std::size_t g = 0; g < layout.groups_.size(); ++g) {
      layout.groups_[g].word = layout.words_++;
      for (std::size_t i = 0; i < layout.groups_[g].members.size(); ++i)
        fluents[layout.groups_[g].members[i]].groups.emplace_back(static_cast<Index>(g),
                                                                  static_cast<Index>(i));
    }
    if (layout.words_ == 0) layout.words_ = 1;
  }

  void make_fluents() {
    const auto each = [&](const std::vector<Symbol>& symbols, const std::vector<Block>& blocks,
                          bool function, const std::vector<char>& changes,
                          std::vector<Index>& numbers) {
      for (Index s = 0; s < symbols.size(); ++s) {
        if (symbols[s].numeric) continue;
        std::vector<Index> arguments(symbols[s].parameters.size());
        const auto visit = [&](const auto& self, std::size_t i) -> void {
          if (i == arguments.size()) {
            const std::size_t n = layout.number(symbols[s], blocks[s], arguments.data());
            if (!changes[n]) return;
            Fluent f;
            f.function = function;
            f.symbol = s;
            f.arguments = arguments;
            f.range = function ? symbols[s].range : kNone;
            numbers[n] = static_cast<Index>(layout.fluents_.size());
            layout.fluents_.push_back(std::move(f));
            return;
          }
          for (const Index o : model.types[symbols[s].parameters[i]].objects) {
            arguments[i] = o;
            self(self, i + 1);
          }
        };
        visit(visit, 0);
      }
    };
    each(model.functions, layout.functions_, true, term_changes, layout.term_fluents_);
    each(model.predicates, layout.predicates_, false, atom_changes, layout.atom_fluents_);
    for (const auto& atoms : group_atoms) {
      Group g;
      for (const auto& [predicate, arguments] : atoms)
        g.members.push_back(layout.atom(predicate, arguments.data()).fluent);
      std::sort(g.members.begin(), g.members.end());
      g.members.erase(std::unique(g.members.begin(), g.members.end()), g.members.end());
      const auto index = static_cast<Index>(layout.groups_.size());
      if (layout.group_by_members_.emplace(g.members, index).second)
        layout.groups_.push_back(std::move(g));
    }
  }

  void run() {
    number_all();
    open_symbols.assign(model.predicates.size(), 0);
    for (const Action& a : model.actions)
      for_each_update(a.effects, [&](const Update& u) { scan(u, false); });
    initial_constants();
    for (const Action& a : model.actions) mark_action(a);
    if (visits >
        kMaximumVisits) {  // too many bindings to look at: everything named by an effect may change
      const auto all = [](const std::vector<Block>& blocks, std::vector<char>& changes) {
        for (std::size_t s = 0; s < blocks.size(); ++s)
          for (std::size_t n = blocks[s].first;
               n < (s + 1 < blocks.size() ? blocks[s + 1].first : changes.size()); ++n)
            changes[n] |= static_cast<char>(blocks[s].changes);
      };
      all(layout.predicates_, atom_changes);
      all(layout.functions_, term_changes);
      for (const Action& a : model.actions)
        for_each_update(a.effects, [](const Update& u) {
          if (u.database == Update::Database::Kx && !u.literals[0].function)
            throw Error(ErrorCode::LimitReached, "too many action instances for effects on Kx");
        });
    }
    make_fluents();
    place_fields();
  }
};

Layout::Layout(const Model& model, Limits& limits) : model_(model) {
  Builder{*this, model, limits, {}, {}, {}, 0, {}}.run();
  limits.work(atom_fluents_.size() * (sizeof(Index) + sizeof(AtomKnowledge)) +
              term_fluents_.size() * 2 * sizeof(Index) + fluents_.size() * (sizeof(Fluent) + 32) +
              model.types.size() * model.objects.size() * sizeof(Index));
}

std::size_t Layout::number(const Symbol& symbol, const Block& block, const Index* arguments) const {
  std::size_t n = 0;
  for (std::size_t i = 0; i < symbol.parameters.size(); ++i) {
    const Index type = symbol.parameters[i];
    const Index p = positions_[type][arguments[i]];
    if (p == kNone) return kNone;
    n = n * model_.types[type].objects.size() + p;
  }
  return block.first + n;
}

Layout::Place Layout::atom(Index predicate, const Index* arguments) const {
  Place place;
  const std::size_t n = number(model_.predicates[predicate], predicates_[predicate], arguments);
  if (n == kNone) {
    place.exists = false;
    return place;
  }
  place.fluent = atom_fluents_[n];
  place.atom = atom_constants_[n];
  return place;
}

Layout::Place Layout::term(Index function, const Index* arguments) const {
  Place place;
  const std::size_t n = number(model_.functions[function], functions_[function], arguments);
  if (n == kNone) {
    place.exists = false;
    return place;
  }
  place.fluent = term_fluents_[n];
  place.value = term_constants_[n];
  return place;
}

Index Layout::sensed_tie(Index fluent, const Word* state) const {
  std::vector<Index> todo = {fluent};
  std::vector<Index> seen = {fluent};
  while (!todo.empty()) {
    const Fluent& f = fluents_[todo.back()];
    todo.pop_back();
    for (const auto& [g, bit] : f.groups) {
      const Group& group = groups_[g];
      if (((state[group.word] >> bit) & 1U) == 0) continue;
      for (std::size_t i = 0; i < group.members.size(); ++i) {
        const Index m = group.members[i];
        if (((state[group.word] >> i) & 1U) == 0 ||
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
