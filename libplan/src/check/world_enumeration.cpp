// Worlds one by one, values that follow from one constraint first.
#include "check/world_enumeration.h"

#include <algorithm>

namespace kaboum::plan {

/// Gives atoms the values that follow by a single constraint. @return false: one is violated.
bool WorldEnumeration::conclude(World& w, std::vector<std::size_t>& concluded) const {
  for (bool again = true; again;) {
    again = false;
    for (const Constraint& c : constraints_) {
      std::size_t holding = 0;
      std::vector<const Constraint::Literal*> open;
      for (const auto& l : c.literals) {
        if (w[l.column] == kNone)
          open.push_back(&l);
        else if ((w[l.column] == l.value) != l.negated)
          ++holding;
      }
      if (holding + open.size() == 0 || (c.exactly_one && holding > 1)) return false;
      const bool all_fail = c.exactly_one && holding == 1;
      if (!all_fail && (holding > 0 || open.size() > 1)) continue;
      for (const auto* l : open) {
        if (!atoms_[l->column] || w[l->column] != kNone) continue;
        w[l->column] = l->negated == all_fail ? 1 : 0;
        concluded.push_back(l->column);
        again = true;
      }
    }
  }
  return true;
}

bool WorldEnumeration::enumerate(World& w, std::size_t most, std::set<World>& out) const {
  std::vector<std::size_t> concluded;
  bool few = true;
  if (conclude(w, concluded)) {
    const auto open = std::find(w.begin(), w.end(), kNone);
    if (open == w.end()) {
      out.insert(w);
      few = out.size() <= most;
    } else {
      const auto column = static_cast<std::size_t>(open - w.begin());
      for (const Index v : ranges_[column]) {
        w[column] = v;
        few = few && enumerate(w, most, out);
      }
      w[column] = kNone;
    }
  }
  for (const std::size_t column : concluded) w[column] = kNone;
  return few;
}

}  // namespace kaboum::plan
