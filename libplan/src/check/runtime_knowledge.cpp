// Knowledge at run time as sets of literals; disjunctions of Kx by unit propagation. The databases
// are those of [petrick2002pks].
#include "check/runtime_knowledge.h"

#include <algorithm>
#include <tuple>

namespace kaboum::plan {

bool RuntimeKnowledge::operator<(const RuntimeKnowledge& o) const {
  return std::tie(atoms_, values_, excluded_, exclusive_, some_, open_, cut_) <
         std::tie(o.atoms_, o.values_, o.excluded_, o.exclusive_, o.some_, o.open_, o.cut_);
}

bool RuntimeKnowledge::knows(const Fact& atom, bool truth) const {
  require_seen(atom);
  const auto found = atoms_.find(atom);
  return found != atoms_.end() && found->second == truth;
}

const Index* RuntimeKnowledge::value(const Fact& term) const {
  require_seen(term);
  const auto found = values_.find(term);
  return found == values_.end() ? nullptr : &found->second;
}

bool RuntimeKnowledge::rules_out(const Fact& term, Index value) const {
  if (const Index* v = this->value(term)) return *v != value;
  const auto found = excluded_.find(term);
  return found != excluded_.end() && found->second.contains(value);
}

bool RuntimeKnowledge::learn(const Fact& atom, bool truth) {
  require_seen(atom);
  const auto [it, fresh] = atoms_.emplace(atom, truth);
  if (!fresh) return it->second == truth;
  return propagate();
}

/// Draws every conclusion from one disjunction at a time.
bool RuntimeKnowledge::propagate() {
  for (bool again = true; again;) {
    again = false;
    if (!conclude_exclusive(again)) return false;
    if (!again && !conclude_some(again)) return false;
  }
  return true;
}

/// Exactly one of the undecided atoms of each entry holds. Stops where it decided something.
bool RuntimeKnowledge::conclude_exclusive(bool& again) {
  for (auto it = exclusive_.begin(); it != exclusive_.end(); ++it) {
    std::set<Fact>& open = it->second;
    std::set<Fact> undecided;
    int holding = 0;
    for (const Fact& f : open) {
      const auto known = atoms_.find(f);
      if (known == atoms_.end()) {
        undecided.insert(f);
      } else if (known->second) {
        ++holding;
      }
    }
    if (holding > 1 || (holding == 0 && undecided.empty())) return false;
    if (holding == 1 || undecided.size() == 1) {
      for (const Fact& f : undecided) atoms_[f] = holding == 0;
      exclusive_.erase(it);
      again = true;
      return true;
    }
    open = undecided;
  }
  return true;
}

/// At least one of the undecided literals of each holds. Stops where it decided something.
bool RuntimeKnowledge::conclude_some(bool& again) {
  std::set<std::set<FactLiteral>> kept;
  for (const std::set<FactLiteral>& literals : some_) {
    std::set<FactLiteral> open;
    bool holds = false;
    for (const FactLiteral& l : literals) {
      const auto known = atoms_.find(l.first);
      if (known == atoms_.end())
        open.insert(l);
      else
        holds |= known->second == l.second;
    }
    if (holds) continue;
    if (open.empty()) return false;
    if (open.size() > 1) {
      kept.insert(std::move(open));
      continue;
    }
    atoms_.insert(*open.begin());
    again = true;
  }
  some_ = std::move(kept);
  return true;
}

bool RuntimeKnowledge::learn_exclusive(const std::set<Fact>& atoms) {
  for (const Fact& f : atoms) require_seen(f);
  exclusive_[atoms] = atoms;
  return propagate();
}

bool RuntimeKnowledge::learn_some(std::set<FactLiteral> literals) {
  for (const FactLiteral& l : literals) require_seen(l.first);
  for (const FactLiteral& l : literals)
    if (literals.contains({l.first, !l.second})) return true;
  some_.insert(std::move(literals));
  return propagate();
}

bool RuntimeKnowledge::learn_value(const Fact& term, Index value, const std::vector<Index>& range) {
  for (const Index other : range)
    if (other != value && !learn_not_value(term, other, range)) return false;
  if (rules_out(term, value)) return false;
  if (this->value(term) == nullptr) become_value(term, value);  // there is no other
  return true;
}

bool RuntimeKnowledge::learn_not_value(const Fact& term, Index value,
                                       const std::vector<Index>& range) {
  if (const Index* v = this->value(term)) return *v != value;
  std::set<Index>& out = excluded_[term];
  out.insert(value);
  if (out.size() >= range.size()) return false;
  if (out.size() + 1 < range.size()) return true;
  for (const Index v : range)
    if (!out.contains(v)) {
      become_value(term, v);
      return true;
    }
  return false;
}

/// A disjunction with this atom undecided says nothing any more about the others. Nothing is lost
/// if it is the only one, and asks of the others no more than that one of them or the atom held.
void RuntimeKnowledge::release(const Fact& atom) {
  require_seen(atom);
  if (atoms_.contains(atom)) return;
  bool ties = false;
  std::size_t gone = std::erase_if(exclusive_, [&](const auto& e) {
    const bool has = e.second.contains(atom);
    ties |= has && e.second.size() > 2;
    return has;
  });
  gone += std::erase_if(some_, [&](const std::set<FactLiteral>& literals) {
    return literals.contains({atom, true}) || literals.contains({atom, false});
  });
  cut_ |= ties || gone > 1;
}

void RuntimeKnowledge::become(const Fact& atom, bool truth) {
  release(atom);
  atoms_[atom] = truth;
}
void RuntimeKnowledge::forget(const Fact& atom) {
  release(atom);
  atoms_.erase(atom);
}
void RuntimeKnowledge::become_value(const Fact& term, Index value) {
  require_seen(term);
  excluded_.erase(term);
  values_[term] = value;
}
void RuntimeKnowledge::forget_value(const Fact& term) {
  require_seen(term);
  excluded_.erase(term);
  values_.erase(term);
}
void RuntimeKnowledge::drop_exclusive(const std::set<Fact>& atoms) {
  if (exclusive_.erase(atoms) > 0) cut_ = true;
}

/// Whether it is known that exactly one of the atoms holds.
bool RuntimeKnowledge::exactly_one(const std::set<Fact>& atoms) const {
  std::set<Fact> undecided;
  int holding = 0;
  for (const Fact& f : atoms) {
    const auto known = atoms_.find(f);
    if (known == atoms_.end())
      undecided.insert(f);
    else if (known->second)
      ++holding;
  }
  if (holding == 1) return undecided.empty();
  return holding == 0 && std::ranges::any_of(exclusive_, [&](const auto& entry) {
           return entry.second == undecided;
         });
}

/// Of the atoms of an entry those of which one may hold.
std::set<Fact> RuntimeKnowledge::candidates(const std::set<Fact>& entry) const {
  if (const auto found = exclusive_.find(entry); found != exclusive_.end()) return found->second;
  std::set<Fact> holding;
  for (const Fact& f : entry)
    if (knows(f, true)) holding.insert(f);
  return holding;
}

void RuntimeKnowledge::weaken_to(const RuntimeKnowledge& other,
                                 const std::set<std::set<Fact>>& entries) {
  std::map<std::set<Fact>, std::set<Fact>> exclusive;
  for (const std::set<Fact>& entry : entries) {
    std::set<Fact> either = candidates(entry);
    either.merge(other.candidates(entry));
    if (either.size() > 1 && exactly_one(either) && other.exactly_one(either))
      exclusive[entry] = std::move(either);
  }
  cut_ |= !some_.empty();
  some_.clear();  // what is not looked for is not in common
  std::erase_if(atoms_, [&](const auto& a) { return !other.knows(a.first, a.second); });
  for (auto& entry : excluded_)
    std::erase_if(entry.second, [&](Index v) { return !other.rules_out(entry.first, v); });
  for (const auto& [term, values] : other.excluded_)
    for (const Index v : values)
      if (values_.contains(term) && rules_out(term, v)) excluded_[term].insert(v);
  std::erase_if(values_, [&](const auto& v) {
    const Index* same = other.value(v.first);
    return same == nullptr || *same != v.second;
  });
  std::erase_if(excluded_, [](const auto& e) { return e.second.empty(); });
  exclusive_ = std::move(exclusive);
  cut_ |= other.cut_;
}

std::set<Fact> RuntimeKnowledge::tied() const {
  std::set<Fact> tied;
  for (const auto& [entry, open] : exclusive_) tied.insert(open.begin(), open.end());
  for (const std::set<FactLiteral>& literals : some_)
    for (const FactLiteral& l : literals) tied.insert(l.first);
  return tied;
}

void RuntimeKnowledge::restrict_to(const std::set<Fact>& live) {
  std::set<Fact> keep = live;
  for (bool again = true; again;) {
    again = false;
    for (const auto& [entry, open] : exclusive_) {
      bool tied = false;
      for (const Fact& f : open) tied |= keep.contains(f);
      if (!tied) continue;
      for (const Fact& f : open) again |= keep.insert(f).second;
    }
    for (const std::set<FactLiteral>& literals : some_) {
      bool tied = false;
      for (const FactLiteral& l : literals) tied |= keep.contains(l.first);
      if (!tied) continue;
      for (const FactLiteral& l : literals) again |= keep.insert(l.first).second;
    }
  }
  std::erase_if(exclusive_, [&](const auto& e) {
    return e.second.empty() || !keep.contains(*e.second.begin());
  });
  cut_ = false;  // of no matter to who keeps a part
  std::erase_if(some_, [&](const std::set<FactLiteral>& literals) {
    return !keep.contains(literals.begin()->first);
  });
  const auto dead = [&](const auto& entry) { return !keep.contains(entry.first); };
  std::erase_if(atoms_, dead);
  std::erase_if(values_, dead);
  std::erase_if(excluded_, dead);
  std::erase_if(open_, [&](const Fact& f) { return !keep.contains(f); });
}

}  // namespace kaboum::plan
