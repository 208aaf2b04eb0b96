// Knowledge at run time as sets of literals; disjunctions of Kx by unit propagation. The databases
// are those of [petrick2002pks].
#include "check/runtime_knowledge.h"

#include <tuple>

namespace kaboum::plan {

bool RuntimeKnowledge::operator<(const RuntimeKnowledge& o) const {
  return std::tie(atoms_, values_, excluded_, exclusive_) <
         std::tie(o.atoms_, o.values_, o.excluded_, o.exclusive_);
}

bool RuntimeKnowledge::knows(const Fact& atom, bool truth) const {
  const auto found = atoms_.find(atom);
  return found != atoms_.end() && found->second == truth;
}

const Index* RuntimeKnowledge::value(const Fact& term) const {
  const auto found = values_.find(term);
  return found == values_.end() ? nullptr : &found->second;
}

bool RuntimeKnowledge::rules_out(const Fact& term, Index value) const {
  if (const Index* v = this->value(term)) return *v != value;
  const auto found = excluded_.find(term);
  return found != excluded_.end() && found->second.contains(value);
}

bool RuntimeKnowledge::learn(const Fact& atom, bool truth) {
  const auto [it, fresh] = atoms_.emplace(atom, truth);
  if (!fresh) return it->second == truth;
  return propagate();
}

/// Exactly one of the undecided atoms of each entry holds; draw every conclusion.
bool RuntimeKnowledge::propagate() {
  for (bool again = true; again;) {
    again = false;
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
        break;
      }
      open = undecided;
    }
  }
  return true;
}

bool RuntimeKnowledge::learn_exclusive(const std::set<Fact>& atoms) {
  exclusive_[atoms] = atoms;
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

/// An entry with this atom undecided says nothing any more about the others.
void RuntimeKnowledge::release(const Fact& atom) {
  if (atoms_.contains(atom)) return;
  std::erase_if(exclusive_, [&](const auto& e) { return e.second.contains(atom); });
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
  excluded_.erase(term);
  values_[term] = value;
}
void RuntimeKnowledge::forget_value(const Fact& term) {
  excluded_.erase(term);
  values_.erase(term);
}
void RuntimeKnowledge::drop_exclusive(const std::set<Fact>& atoms) { exclusive_.erase(atoms); }

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
  }
  std::erase_if(exclusive_, [&](const auto& e) {
    return e.second.empty() || !keep.contains(*e.second.begin());
  });
  const auto dead = [&](const auto& entry) { return !keep.contains(entry.first); };
  std::erase_if(atoms_, dead);
  std::erase_if(values_, dead);
  std::erase_if(excluded_, dead);
}

}  // namespace kaboum::plan
