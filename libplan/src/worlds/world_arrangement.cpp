// Which variables worlds may differ in, and which of them form a component: those that an initial
// constraint, an observation, or a condition of the world ties together.
#include "worlds/world_arrangement.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace kaboum::plan::worlds {
namespace {

using Kind = Condition::Kind;

class Arrangement {
 public:
  Arrangement(WorldTask& task, Limits& limits) : task_(task), limits_(limits) {}

  void run() {
    leave_unreachable_out();
    find_hidden();
    find_components();
    place();
  }

 private:
  // Delete relaxation over all worlds.

  void leave_unreachable_out() {
    std::vector<std::vector<char>> may(task_.variables.size());
    for (std::size_t v = 0; v < may.size(); ++v) {
      const Variable& variable = task_.variables[v];
      may[v].assign(variable.size, variable.initial == kNone ? 1 : 0);
      if (variable.initial != kNone) may[v][variable.initial] = 1;
    }
    std::vector<char> reached(task_.operators.size(), 0);
    for (bool again = true; again;) {
      again = false;
      for (std::size_t o = 0; o < reached.size(); ++o) {
        limits_.work();
        Operator& op = task_.operators[o];
        if (!possible(op.precondition, may)) continue;
        reached[o] = 1;
        for (const Step& s : op.steps) {
          if (!possible(s.known, may) || !possible(s.world, may)) continue;
          const auto reach = [&](Index v, Index value) {
            again |= may[v][value] == 0;
            may[v][value] = 1;
          };
          if (s.kind == Step::Kind::Set) reach(s.variable, s.value);
          if (s.kind == Step::Kind::Free || s.kind == Step::Kind::Rule ||
              s.kind == Step::Kind::OneOf) {
            for (Index value = 0; value < task_.variables[s.variable].size; ++value)
              reach(s.variable, value);
            for (const auto& [v, value] : s.options)
              for (Index w = 0; w < task_.variables[v].size; ++w) reach(v, w);
          }
        }
      }
    }
    std::vector<Operator> kept;
    for (std::size_t o = 0; o < reached.size(); ++o) {
      if (reached[o] == 0) continue;
      Operator& op = task_.operators[o];
      std::erase_if(op.steps, [&](const Step& s) {
        return !possible(s.known, may) || !possible(s.world, may);
      });
      kept.push_back(std::move(op));
    }
    task_.operators = std::move(kept);
  }
  /// false: no world has it.
  static bool possible(const Condition& c, const std::vector<std::vector<char>>& may) {
    switch (c.kind) {
      case Kind::False:
        return false;
      case Kind::And:
        return std::all_of(c.children.begin(), c.children.end(),
                           [&](const Condition& child) { return possible(child, may); });
      case Kind::Or:
        return std::any_of(c.children.begin(), c.children.end(),
                           [&](const Condition& child) { return possible(child, may); });
      case Kind::Is:
        return may[c.variable][c.value] != 0;
      case Kind::IsNot:
        for (Index v = 0; v < may[c.variable].size(); ++v)
          if (v != c.value && may[c.variable][v] != 0) return true;
        return false;
      default:
        return true;
    }
  }

  // What may differ between worlds, and what depends on what.

  template <class Visit>
  static void read(const Condition& c, const Visit& visit) {
    if (c.kind >= Kind::Is) visit(c.variable);
    for (const Condition& child : c.children) read(child, visit);
  }

  void find_hidden() {
    for (Variable& v : task_.variables) v.hidden = v.initial == kNone;
    for (const Operator& o : task_.operators)
      for (const Step& s : o.steps) {
        if (s.kind != Step::Kind::Set && s.kind != Step::Kind::Sense)
          task_.variables[s.variable].hidden = true;
        for (const auto& [v, value] : s.options) task_.variables[v].hidden = true;
      }
    for (bool again = true; again;) {
      again = false;
      for (const Operator& o : task_.operators)
        for (const Step& s : o.steps) {
          if (s.kind != Step::Kind::Set || task_.variables[s.variable].hidden) continue;
          bool reads = false;
          read(s.world, [&](Index v) { reads |= task_.variables[v].hidden; });
          if (reads) task_.variables[s.variable].hidden = again = true;
        }
    }
  }

  void find_components() {
    std::vector<Index> root(task_.variables.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](Index v) {
      while (root[v] != v) v = root[v] = root[root[v]];
      return v;
    };
    const auto join = [&](Index a, Index b) {
      if (task_.variables[a].hidden && task_.variables[b].hidden) root[find(a)] = find(b);
    };
    for (const Constraint& c : task_.constraints)
      for (const Constraint::Literal& l : c.literals) {
        if (task_.variables[l.variable].initial == kNone &&
            task_.variables[c.literals[0].variable].initial == kNone)
          join(l.variable, c.literals[0].variable);
      }
    // A literal that is known may stand between two that are not.
    for (const Constraint& c : task_.constraints) {
      Index first = kNone;
      for (const Constraint::Literal& l : c.literals) {
        if (task_.variables[l.variable].initial != kNone) continue;
        if (first == kNone) first = l.variable;
        join(l.variable, first);
      }
    }
    for (const Operator& o : task_.operators)
      for (const Step& s : o.steps) {
        read(s.world, [&](Index v) { join(v, s.variable); });
        Index hidden = kNone;
        read(s.world, [&](Index v) {
          if (!task_.variables[v].hidden) return;
          if (hidden != kNone) join(v, hidden);
          hidden = v;
        });
        for (const auto& [v, value] : s.options) join(v, s.variable);
      }
    std::map<Index, Index> numbers;
    for (Index v = 0; v < root.size(); ++v) {
      if (!task_.variables[v].hidden) continue;
      const auto [it, fresh] =
          numbers.emplace(find(v), static_cast<Index>(task_.components.size()));
      if (fresh) task_.components.emplace_back();
      task_.variables[v].component = it->second;
      task_.components[it->second].variables.push_back(v);
    }
    for (Operator& o : task_.operators) {
      for (const Step& s : o.steps)
        if (task_.variables[s.variable].hidden)
          o.components.push_back(task_.variables[s.variable].component);
      std::sort(o.components.begin(), o.components.end());
      o.components.erase(std::unique(o.components.begin(), o.components.end()), o.components.end());
    }
  }

  void place() {
    Index used = 64;
    const auto put = [](Variable& v, Index& words, Index& bits) {
      const auto width = static_cast<Index>(std::bit_width(std::max<Index>(v.size, 2) - 1));
      if (words == 0 || bits + width > 64) {
        ++words;
        bits = 0;
      }
      v.word = words - 1;
      v.shift = bits;
      v.mask = (Word{1} << width) - 1;
      bits += width;
    };
    for (Variable& v : task_.variables)
      if (!v.hidden) put(v, task_.common_words, used);
    for (WorldTask::Component& c : task_.components) {
      Index bits = 64;
      for (const Index v : c.variables) put(task_.variables[v], c.words, bits);
    }
  }

  WorldTask& task_;
  Limits& limits_;
};

}  // namespace

void arrange_worlds(WorldTask& task, Limits& limits) { Arrangement(task, limits).run(); }

}  // namespace kaboum::plan::worlds
