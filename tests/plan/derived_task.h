#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace kaboum::plan::test {

/// A random task with derived predicates, as PDDL; and what is true of it, by definition: rules are
/// applied to all objects until nothing changes, stratum by stratum, in every state.
class DerivedTask {
 public:
  struct Step {
    std::size_t action = 0;
    std::vector<int> arguments;
  };

  explicit DerivedTask(std::uint32_t seed) : random_(seed) {
    for (int stratum = 0; stratum < kStrata; ++stratum) {
      // Of its stratum positive atoms alone; below, any.
      stratum_ = stratum;
      for (int p = kBase; p < kPredicates; ++p) {
        if (stratum_of(p) != stratum) continue;
        for (int n = 1 + pick(2); n > 0; --n) {
          Rule r;
          r.predicate = p;
          for (int i = 0; i < kArity[p]; ++i) r.small.push_back(pick(4) == 0);
          variables_ = kArity[p];
          r.body = formula(2, true);
          rules_.push_back(std::move(r));
        }
      }
    }
    stratum_ = kStrata;
    for (int i = 0; i < 3; ++i) {
      Action a;
      a.parameters = pick(3);
      variables_ = a.parameters;
      a.precondition = formula(1, true);
      for (int n = 1 + pick(3); n > 0; --n) {
        Change c;
        variables_ = a.parameters;
        c.adds = pick(3) != 0;
        c.atom = atom(pick(kBase));
        if (pick(3) == 0) c.condition = formula(1, true);
        a.changes.push_back(std::move(c));
      }
      actions_.push_back(std::move(a));
    }
    variables_ = 0;
    goal_ = {Formula::And, 0, {}, false, {formula(1, true), formula(2, true)}};
    for (int p = 0; p < kBase; ++p)
      for_each_tuple(kArity[p], [&](const std::vector<int>& objects) {
        if (pick(3) == 0) start_.insert(key(p, objects));
      });
  }

  [[nodiscard]] std::string pddl() const {
    std::string out =
        "(define (domain d) (:requirements :adl :derived-predicates) (:types t - object s - t)\n"
        " (:predicates (p0) (p1 ?x - t) (p2 ?x ?y - t) (d3 ?x - t) (d4 ?x ?y - t) (d5) (d6 ?x - "
        "t))\n";
    for (const Rule& r : rules_) {
      out += " (:derived (" + kNames[r.predicate];
      for (std::size_t i = 0; i < r.small.size(); ++i)
        out += " ?v" + std::to_string(i) + " - " + (r.small[i] ? "s" : "t");
      out += ") " + text(r.body) + ")\n";
    }
    for (std::size_t i = 0; i < actions_.size(); ++i) {
      const Action& a = actions_[i];
      out += " (:action a" + std::to_string(i) + " :parameters (";
      for (int v = 0; v < a.parameters; ++v) out += " ?v" + std::to_string(v) + " - t";
      out += ") :precondition " + text(a.precondition) + "\n  :effect (and";
      for (const Change& c : a.changes) {
        const std::string set = c.adds ? text(c.atom) : "(not " + text(c.atom) + ")";
        out += c.condition ? " (when " + text(*c.condition) + " " + set + ")" : " " + set;
      }
      out += "))\n";
    }
    out += ")\n(define (problem p) (:domain d) (:objects o0 - s o1 o2 - t)\n (:init";
    for (const auto& k : start_) {
      out += " (" + kNames[k[0]];
      for (std::size_t i = 1; i < k.size(); ++i) out += " o" + std::to_string(k[i]);
      out += ")";
    }
    return out + ")\n (:goal " + text(goal_) + "))\n";
  }

  /// Fewest steps to the goal, if there is a plan; nothing beyond so many states.
  [[nodiscard]] std::optional<std::optional<std::uint64_t>> fewest_steps(std::size_t most) const {
    std::map<State, std::uint64_t> seen = {{start_, 0}};
    std::deque<State> queue = {start_};
    for (; !queue.empty(); queue.pop_front()) {
      const State state = queue.front();
      const State all = completed(state);
      std::vector<int> slots(kSlots, 0);
      if (holds(goal_, all, slots)) return seen.at(state);
      if (seen.size() > most) return std::nullopt;
      for (std::size_t i = 0; i < actions_.size(); ++i)
        for_each_tuple(actions_[i].parameters, [&](const std::vector<int>& arguments) {
          const auto next = after({i, arguments}, state, all);
          if (next && seen.emplace(*next, seen.at(state) + 1).second) queue.push_back(*next);
        });
    }
    return std::optional<std::uint64_t>();
  }

  [[nodiscard]] Step any_step(std::mt19937& random) const {
    Step s{random() % actions_.size(), {}};
    for (int i = 0; i < actions_[s.action].parameters; ++i)
      s.arguments.push_back(static_cast<int>(random() % kObjects));
    return s;
  }

  [[nodiscard]] bool is_plan(const std::vector<Step>& steps) const {
    State state = start_;
    for (const Step& s : steps) {
      const auto next = after(s, state, completed(state));
      if (!next) return false;
      state = *next;
    }
    std::vector<int> slots(kSlots, 0);
    return holds(goal_, completed(state), slots);
  }

 private:
  using Key = std::vector<int>;  ///< predicate and objects
  using State = std::set<Key>;

  struct Formula {
    enum Kind { Atom, Same, And, Or, Imply, Not, Exists, ForAll } kind = Atom;
    int symbol = 0;              ///< predicate, or the variable that is quantified
    std::vector<int> arguments;  ///< objects, or -1 - variable
    bool small = false;          ///< quantified over the subtype
    std::vector<Formula> parts;
  };
  struct Rule {
    int predicate = 0;
    std::vector<bool> small;  ///< by parameter: of the subtype
    Formula body;
  };
  struct Change {
    bool adds = true;
    Formula atom;
    std::optional<Formula> condition;
  };
  struct Action {
    int parameters = 0;
    Formula precondition;
    std::vector<Change> changes;
  };

  static constexpr int kObjects = 3;  ///< of which the first is of the subtype
  static constexpr int kBase = 3, kPredicates = 7, kStrata = 3, kSlots = 16;
  static constexpr std::array<int, kPredicates> kArity = {0, 1, 2, 1, 2, 0, 1};
  static inline const std::array<std::string, kPredicates> kNames = {"p0", "p1", "p2", "d3",
                                                                     "d4", "d5", "d6"};
  /// d3 and d4, then d5, then d6.
  static int stratum_of(int predicate) { return predicate < 5 ? 0 : predicate - 4; }

  int pick(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }

  template <class Visit>
  static void for_each_tuple(int size, const Visit& visit) {
    int count = 1;
    for (int i = 0; i < size; ++i) count *= kObjects;
    for (int n = 0; n < count; ++n) {
      std::vector<int> objects;
      for (int i = 0, left = n; i < size; ++i, left /= kObjects) objects.push_back(left % kObjects);
      visit(objects);
    }
  }

  static Key key(int predicate, const std::vector<int>& objects) {
    Key k = {predicate};
    k.insert(k.end(), objects.begin(), objects.end());
    return k;
  }

  int argument() { return variables_ > 0 && pick(5) != 0 ? -1 - pick(variables_) : pick(kObjects); }

  Formula atom(int predicate) {
    Formula f;
    f.symbol = predicate;
    for (int i = 0; i < kArity[predicate]; ++i) f.arguments.push_back(argument());
    return f;
  }

  /// @param positive  it stands below an even number of negations.
  Formula formula(int depth, bool positive) {
    Formula f;
    switch (depth > 0 ? pick(9) : 8) {
      case 0:
      case 1:
        f.kind = Formula::And;
        break;
      case 2:
        f.kind = Formula::Or;
        break;
      case 3:
        f.kind = Formula::Imply;
        f.parts = {formula(depth - 1, !positive), formula(depth - 1, positive)};
        return f;
      case 4:
        f.kind = Formula::Not;
        f.parts = {formula(depth - 1, !positive)};
        return f;
      case 5:
      case 6:
      case 7: {
        f.kind = pick(3) != 0 ? Formula::Exists : Formula::ForAll;
        f.symbol = variables_++;
        f.small = pick(4) == 0;
        f.parts = {{Formula::And, 0, {}, false, {}}};
        if (f.kind == Formula::ForAll) f.parts[0].kind = Formula::Or;
        for (int n = 2; n > 0; --n) f.parts[0].parts.push_back(formula(depth - 1, positive));
        --variables_;
        return f;
      }
      default: {
        if (pick(12) == 0) {
          f.kind = Formula::Same;
          f.arguments = {argument(), argument()};
          return f;
        }
        const bool negated = pick(3) == 0;
        const bool even = positive != negated;
        int predicate = pick(kPredicates);
        while (predicate >= kBase &&
               (even ? stratum_of(predicate) > stratum_ : stratum_of(predicate) >= stratum_))
          predicate = pick(kPredicates);
        f = atom(predicate);
        if (!negated) return f;
        return {Formula::Not, 0, {}, false, {f}};
      }
    }
    f.parts = {formula(depth - 1, positive), formula(depth - 1, positive)};
    return f;
  }

  [[nodiscard]] static std::string text(const Formula& f) {
    const auto word = [](int a) {
      return a < 0 ? " ?v" + std::to_string(-1 - a) : " o" + std::to_string(a);
    };
    std::string out = "(";
    switch (f.kind) {
      case Formula::Atom:
        out += kNames[f.symbol];
        break;
      case Formula::Same:
        out += "=";
        break;
      case Formula::And:
        out += "and";
        break;
      case Formula::Or:
        out += "or";
        break;
      case Formula::Imply:
        out += "imply";
        break;
      case Formula::Not:
        out += "not";
        break;
      case Formula::Exists:
      case Formula::ForAll:
        out += std::string(f.kind == Formula::Exists ? "exists" : "forall") + " (" +
               word(-1 - f.symbol) + " - " + (f.small ? "s" : "t") + ")";
        break;
    }
    for (const int a : f.arguments) out += word(a);
    for (const Formula& p : f.parts) out += " " + text(p);
    return out + ")";
  }

  static bool holds(const Formula& f, const State& state, std::vector<int>& slots) {
    const auto object = [&](int a) { return a < 0 ? slots.at(-1 - a) : a; };
    switch (f.kind) {
      case Formula::Atom: {
        std::vector<int> objects;
        for (const int a : f.arguments) objects.push_back(object(a));
        return state.contains(key(f.symbol, objects));
      }
      case Formula::Same:
        return object(f.arguments[0]) == object(f.arguments[1]);
      case Formula::Not:
        return !holds(f.parts[0], state, slots);
      case Formula::Imply:
        return !holds(f.parts[0], state, slots) || holds(f.parts[1], state, slots);
      case Formula::And:
      case Formula::Or: {
        bool all = true, any = false;
        for (const Formula& p : f.parts) {
          const bool h = holds(p, state, slots);
          all = all && h;
          any = any || h;
        }
        return f.kind == Formula::And ? all : any;
      }
      case Formula::Exists:
      case Formula::ForAll: {
        bool all = true, any = false;
        for (int o = 0; o < (f.small ? 1 : kObjects); ++o) {
          slots.at(f.symbol) = o;
          const bool h = holds(f.parts[0], state, slots);
          all = all && h;
          any = any || h;
        }
        return f.kind == Formula::ForAll ? all : any;
      }
    }
    return false;
  }

  /// The state with all derived atoms.
  [[nodiscard]] State completed(State state) const {
    for (int stratum = 0; stratum < kStrata; ++stratum)
      for (bool more = true; more;) {
        more = false;
        for (const Rule& r : rules_) {
          if (stratum_of(r.predicate) != stratum) continue;
          for_each_tuple(kArity[r.predicate], [&](const std::vector<int>& objects) {
            for (std::size_t i = 0; i < objects.size(); ++i)
              if (r.small[i] && objects[i] != 0) return;
            std::vector<int> slots(objects);
            slots.resize(kSlots, 0);
            if (holds(r.body, state, slots)) more |= state.insert(key(r.predicate, objects)).second;
          });
        }
      }
    return state;
  }

  /// What the step makes of a state; nothing if it is not possible. Additions win over deletions.
  [[nodiscard]] std::optional<State> after(const Step& step, const State& state,
                                           const State& all) const {
    const Action& a = actions_[step.action];
    std::vector<int> slots(step.arguments);
    slots.resize(kSlots, 0);
    if (!holds(a.precondition, all, slots)) return std::nullopt;
    State next = state;
    for (const bool adds : {false, true})
      for (const Change& c : a.changes) {
        if (c.adds != adds || (c.condition && !holds(*c.condition, all, slots))) continue;
        std::vector<int> objects;
        for (const int x : c.atom.arguments) objects.push_back(x < 0 ? slots.at(-1 - x) : x);
        if (adds)
          next.insert(key(c.atom.symbol, objects));
        else
          next.erase(key(c.atom.symbol, objects));
      }
    return next;
  }

  std::mt19937 random_;
  int stratum_ = 0;
  int variables_ = 0;
  std::vector<Rule> rules_;
  std::vector<Action> actions_;
  Formula goal_;
  State start_;
};

}  // namespace kaboum::plan::test
