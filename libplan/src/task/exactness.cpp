// Whether a knowledge state says all that could be concluded: it is a product of what is known of
// each atom and term, so what ties unknown ones together is lost.
// docs/planning/knowledge-states.md, "What is lost".
#include "task/exactness.h"

#include <algorithm>
#include <set>
#include <vector>

namespace kaboum::plan {
namespace {

class Exactness {
 public:
  Exactness(const Model& model, bool worlds)
      : model_(model),
        worlds_(worlds),
        unknown_atoms_(model.predicates.size(), 0),
        unknown_terms_(model.functions.size(), 0) {
    initially_unknown();
    for (bool again = true; again;) {
      again = false;
      for (const Action& a : model.actions) again |= forget(a.effects);
    }
  }

  std::string lost() const {
    if (model_.cut) return "more is known than the disjunctions that were taken over say";
    for (const Update& u : model_.initial)
      if (is_disjunction(u) && !worlds_) return kDisjunctions;
    for (const Action& a : model_.actions) {
      std::string found = lost_by(a.effects);
      if (!found.empty()) return found + " (action '" + a.name + "')";
    }
    return "";
  }

 private:
  static constexpr const char* kDisjunctions =
      "of several entries of Kx not all is concluded that follows";

  static bool is_disjunction(const Update& u) {
    return u.database == Update::Database::Kx && !u.literals[0].function;
  }

  /// Symbols of which the initial entries leave an instance unknown.
  void initially_unknown() {
    std::set<std::vector<Index>> known;
    std::vector<std::size_t> atoms(model_.predicates.size(), 0), terms(model_.functions.size(), 0);
    for (const Update& u : model_.initial) {
      const Update::Literal& l = u.literals[0];
      if (u.database == Update::Database::Kx || (l.function && l.negated)) continue;
      std::vector<Index> key = {l.function ? Index{1} : Index{0}, l.symbol};
      for (const Argument& a : l.arguments) key.push_back(a.index);
      if (known.insert(std::move(key)).second) ++(l.function ? terms : atoms)[l.symbol];
    }
    const auto compare = [&](const std::vector<Symbol>& symbols,
                             const std::vector<std::size_t>& count, std::vector<char>& unknown) {
      for (std::size_t s = 0; s < symbols.size(); ++s) {
        double instances = 1;
        for (const Index type : symbols[s].parameters)
          instances *= static_cast<double>(model_.types[type].objects.size());
        unknown[s] = !symbols[s].numeric && static_cast<double>(count[s]) < instances ? 1 : 0;
      }
    };
    compare(model_.predicates, atoms, unknown_atoms_);
    compare(model_.functions, terms, unknown_terms_);
  }

  [[nodiscard]] char unknown(const Update::Literal& l) const {
    return (l.function ? unknown_terms_ : unknown_atoms_)[l.symbol];
  }

  /// Symbols of which these effects may make an instance unknown. @return whether one is new.
  bool forget(const std::vector<Effect>& effects) {
    bool fresh = false;
    for (const Effect& e : effects) {
      if (e.kind == Effect::Kind::When && !may_hold(e.condition)) continue;
      if (e.of_world && reads_unknown(e.condition)) fresh |= forget_targets(e.children);
      fresh |= forget(e.children);
      if (e.kind != Effect::Kind::Update || (e.update.add && !may_lose(e.update))) continue;
      for (const Update::Literal& l : e.update.literals) {
        char& u = (l.function ? unknown_terms_ : unknown_atoms_)[l.symbol];
        fresh |= u == 0;
        u = 1;
      }
    }
    return fresh;
  }

  /// Of a condition of the world that is not known: all that hangs on it may be unknown then.
  bool forget_targets(const std::vector<Effect>& effects) {
    bool fresh = false;
    for (const Effect& e : effects) {
      fresh |= forget_targets(e.children);
      if (e.kind != Effect::Kind::Update) continue;
      for (const Update::Literal& l : e.update.literals) {
        char& u = (l.function ? unknown_terms_ : unknown_atoms_)[l.symbol];
        fresh |= u == 0;
        u = 1;
      }
    }
    return fresh;
  }

  /// Additions after which a fluent may be unknown: those that only may happen, and observations of
  /// a term, which may contradict its value.
  [[nodiscard]] bool may_lose(const Update& u) const {
    const auto& value = u.literals[0].value;
    if (value && value->term && unknown_terms_[value->term->function] != 0) return true;
    return u.maybe || u.database == Update::Database::Kx ||
           (u.database == Update::Database::Kf && u.literals[0].function && u.literals[0].negated);
  }

  /// false: it asks that something be unknown that never is.
  [[nodiscard]] bool may_hold(const Query& q) const {
    if (q.kind == Query::Kind::And)
      return std::all_of(q.children.begin(), q.children.end(),
                         [&](const Query& c) { return may_hold(c); });
    if (q.kind != Query::Kind::Not) return true;
    const Query& c = q.children[0];
    if (c.kind == Query::Kind::KnowWhether) return unknown_atoms_[c.symbol] != 0;
    if (c.kind == Query::Kind::WhetherValue || c.kind == Query::Kind::KnowValue)
      return unknown_terms_[c.symbol] != 0;
    return true;
  }

  /// Whether the query may fail only because something that it reads is unknown.
  [[nodiscard]] bool reads_unknown(const Query& q) const {
    if (q.kind == Query::Kind::Known) return unknown_atoms_[q.symbol] != 0;
    if (q.kind == Query::Kind::KnownValue) return unknown_terms_[q.symbol] != 0;
    if (q.kind == Query::Kind::External || q.kind == Query::Kind::Let) return calls_unknown(q);
    return std::any_of(q.children.begin(), q.children.end(),
                       [&](const Query& c) { return reads_unknown(c); });
  }

  /// A call may hang on what is unknown: by its arguments, or by what it reads of the state.
  [[nodiscard]] bool calls_unknown(const Query& q) const {
    const auto some = [](const std::vector<char>& unknown) {
      return std::any_of(unknown.begin(), unknown.end(), [](char u) { return u != 0; });
    };
    if (model_.external_functions[q.symbol].reads_state &&
        (some(unknown_atoms_) || some(unknown_terms_)))
      return true;
    return std::any_of(q.arguments.begin(), q.arguments.end(), [&](const Argument& a) {
      return a.term && unknown_terms_[a.term->function] != 0;
    });
  }

  [[nodiscard]] std::string lost_by(const std::vector<Effect>& effects) const {
    for (const Effect& e : effects) {
      if (e.kind == Effect::Kind::When) {
        if (!may_hold(e.condition)) continue;
        if (!e.of_world && reads_unknown(e.condition))
          return "an effect whose condition is not known either way leaves no trace of the tie "
                 "between the two";
      }
      if (e.kind == Effect::Kind::Update && !worlds_) {
        if (is_disjunction(e.update)) return kDisjunctions;
        if (e.update.maybe) return "what 'maybe' happens together is not remembered";
      }
      std::string found = lost_by(e.children);
      if (!found.empty()) return found;
    }
    return "";
  }

  const Model& model_;
  bool worlds_;
  std::vector<char> unknown_atoms_, unknown_terms_;  ///< by symbol: an instance may be unknown
};

}  // namespace

std::string lost_knowledge(const Model& model) { return Exactness(model, false).lost(); }
std::string lost_in_worlds(const Model& model) { return Exactness(model, true).lost(); }

}  // namespace kaboum::plan
