// Regression of a condition through one step, in the context of the state in which it was planned.
#include "search/regression.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <set>

namespace kaboum::plan {

namespace {

using Kind = FormulaPool::Kind;

bool is_connective(Kind k) {
  return k == Kind::And || k == Kind::Or || k == Kind::Xor || k == Kind::Not;
}

/// Whether a formula reads a field that `touched` covers.
bool leaf_touched(const FormulaPool& pool, const Layout& layout, Formula f,
                  const std::vector<Word>& touched) {
  const FormulaPool::Node& n = pool.node(f);
  if (n.kind == Kind::Bits) return (touched[n.a] & pool.bits_mask(n)) != 0;
  if (n.kind == Kind::True || n.kind == Kind::False || n.kind == Kind::External) return false;
  if (n.kind == Kind::Derived)  // by some rule or other
    return std::any_of(touched.begin(), touched.end(), [](Word w) { return w != 0; });
  const Fluent& fluent = layout.fluents()[n.a];
  if ((touched[fluent.word] & fluent.mask) != 0) return true;
  for (Index i = 0; i < fluent.exclusion_words; ++i)
    if (touched[fluent.exclusions + i] != 0) return true;
  return false;
}

}  // namespace

bool Regression::overlaps(Formula f) const {
  const FormulaPool& pool = task_.pool();
  if (is_connective(pool.node(f).kind))
    return std::any_of(pool.begin(f), pool.end(f), [&](Formula c) { return overlaps(c); });
  return leaf_touched(pool, task_.layout(), f, touched_);
}

/// Whether the formula reads this fluent's field.
bool Regression::reads_field(Formula f, const Fluent& fluent) const {
  std::vector<Word> field(touched_.size(), 0);
  field[fluent.word] = fluent.mask;
  const FormulaPool& pool = task_.pool();
  const auto reads = [&](const auto& self, Formula g) -> bool {
    if (is_connective(pool.node(g).kind))
      return std::any_of(pool.begin(g), pool.end(g), [&](Formula c) { return self(self, c); });
    return leaf_touched(pool, task_.layout(), g, field);
  };
  return reads(reads, f);
}

void Regression::require_as_before(const Fluent& fluent) {
  FormulaPool& pool = task_.pool();
  required_.push_back(pool.bits(fluent.word, fluent.mask, before_[fluent.word] & fluent.mask));
  for (Index i = 0; i < fluent.exclusion_words; ++i)
    required_.push_back(pool.bits(fluent.exclusions + i, ~Word{0}, before_[fluent.exclusions + i]));
}

/// The fluent's content after the step is not (always) what it was; if `plain`, it does not depend
/// on what it was either. Knowledge in Kx groups spreads: all fluents tied to it count as touched.
void Regression::touch(Index fluent, bool plain) {
  const Layout& layout = task_.layout();
  for (const Index tied : tied_to(fluent)) {
    const Fluent& f = layout.fluents()[tied];
    touched_[f.word] |= f.mask;
    for (Index i = 0; i < f.exclusion_words; ++i) touched_[f.exclusions + i] = ~Word{0};
    const bool depends = !plain || !f.groups.empty();
    if (depends) require_as_before(f);
    for (const auto& [g, bit] : f.groups) {
      const Group& group = layout.groups()[g];
      for (Index w = 0; w < group.words(); ++w) {
        touched_[group.word + w] = ~Word{0};
        require_word(group.word + w);
      }
    }
  }
}

void Regression::require_word(Index word) {
  required_.push_back(task_.pool().bits(word, ~Word{0}, before_[word]));
}

/// The fluent, and all that Kx entries tie to it, whether they hold now or not.
std::vector<Index> Regression::tied_to(Index fluent) const {
  const Layout& layout = task_.layout();
  std::vector<Index> all = {fluent};
  std::set<Index> seen = {fluent};
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const auto& [g, bit] : layout.fluents()[all[i]].groups)
      for (const Index m : layout.groups()[g].members)
        if (seen.insert(m).second) all.push_back(m);
  return all;
}

/// Fluents that `f` reads: their content before the step is required to be what it was.
void Regression::require_read(Formula f) {
  FormulaPool& pool = task_.pool();
  const Kind kind = pool.node(f).kind;
  if (is_connective(kind)) {
    const std::vector<Formula> children(pool.begin(f), pool.end(f));
    for (const Formula c : children) require_read(c);
  } else if (kind == Kind::Bits) {
    const FormulaPool::Node n = pool.node(f);
    required_.push_back(pool.bits(n.a, pool.bits_mask(n), before_[n.a] & pool.bits_mask(n)));
  } else if (kind == Kind::Derived) {
    for (const Index fluent : task_.derived().fluents(pool.node(f).a))
      require_as_before(task_.layout().fluents()[fluent]);
  } else if (kind != Kind::True && kind != Kind::False && kind != Kind::External) {
    for (const Index fluent : tied_to(pool.node(f).a)) {
      const Fluent& read = task_.layout().fluents()[fluent];
      require_as_before(read);
      for (const auto& [g, bit] : read.groups) {
        const Group& group = task_.layout().groups()[g];
        for (Index w = 0; w < group.words(); ++w) require_word(group.word + w);
      }
    }
  }
}

Formula Regression::rewrite(Formula f) {
  FormulaPool& pool = task_.pool();
  const FormulaPool::Node n = pool.node(f);
  if (is_connective(n.kind)) {
    std::vector<Formula> children(pool.begin(f), pool.end(f));
    for (Formula& c : children) c = rewrite(c);
    switch (n.kind) {
      case Kind::And:
        return pool.all(children);
      case Kind::Or:
        return pool.any(children);
      case Kind::Xor:
        return pool.one(children);
      default:
        return pool.negate(children[0]);
    }
  }
  if (!leaf_touched(pool, task_.layout(), f, touched_)) return f;
  if (n.kind == Kind::Bits) {
    const Word mask = pool.bits_mask(n);
    const Word value = pool.bits_value(n);
    const Word set = mask & touched_[n.a];
    if (((after_.words()[n.a] ^ value) & set) != 0) return kFalse;
    return pool.bits(n.a, mask & ~set, value & ~set);
  }
  const Truth t = task_.evaluator().evaluate(f, after_.words());
  if (n.kind == Kind::Derived) require_read(f);
  if (t == Truth::Open) {
    open_ = true;
    return f;
  }
  return t == Truth::Yes ? kTrue : kFalse;
}

void Regression::require_footprint(Index call, const Word* state, std::vector<Formula>& out) {
  std::vector<Index> fluents;
  task_.calls().footprint(call, state, fluents);
  for (const Index i : fluents) {
    const Fluent& f = task_.layout().fluents()[i];
    out.push_back(task_.pool().bits(f.word, f.mask, state[f.word] & f.mask));
  }
}

/// A formula that holds in `state` and, wherever it holds, `f` has the same truth as there; calls
/// that read the state are replaced by what they read.
/// @pre `f` is Yes or No in `state`.
Formula Regression::freeze(Formula f, const Word* state) {
  FormulaPool& pool = task_.pool();
  const bool truth = task_.evaluator().holds(f, state);
  const FormulaPool::Node n = pool.node(f);
  if (!n.calls) return truth ? f : pool.negate(f);
  const std::vector<Formula> children = is_connective(n.kind)
                                            ? std::vector<Formula>(pool.begin(f), pool.end(f))
                                            : std::vector<Formula>{};
  std::vector<Formula> kept;
  switch (n.kind) {
    case Kind::External:
      require_footprint(n.a, state, kept);
      return pool.all(kept);
    case Kind::Not:
      return freeze(children[0], state);
    case Kind::And:
    case Kind::Or:
      if (truth == (n.kind == Kind::Or)) {  // one child decides: the first in the order of calls
        for (const Formula c : children) {
          const Truth t = task_.evaluator().evaluate(c, state);
          if (t == (truth ? Truth::Yes : Truth::No)) return freeze(c, state);
        }
        break;
      }
      [[fallthrough]];
    default:  // Xor: all children; or two that hold, so that others may be undecided
      for (const Formula c : children) {
        const Truth t = task_.evaluator().evaluate(c, state);
        if (t == Truth::Yes || t == Truth::No) kept.push_back(freeze(c, state));
      }
      return pool.all(kept);
  }
  throw Error(ErrorCode::Internal, "a formula is decided by none of its parts");
}

/// A handle's term that takes over a value: what that rests on matters if the condition reads it.
void Regression::touch_transfer(const ConditionalEffect::Transfer& t, bool happens,
                                Formula condition) {
  const auto& fluents = task_.layout().fluents();
  const Fluent& f = fluents[t.fluent];
  touch_field(f.mask, f.word);
  if (t.operand == kNone) return;  // unknown then, whatever it was
  if (happens && !reads_field(condition, f)) return;
  if (is_call(t.operand)) {
    require_footprint(t.operand & ~kCallOperand, before_, required_);
  } else if (is_term(t.operand)) {
    require_as_before(fluents[t.operand & ~kTermOperand]);
  }
}

Formula Regression::before(OperatorId step, Formula condition, const Word* before) {
  FormulaPool& pool = task_.pool();
  before_ = before;
  touched_.assign(task_.layout().words(), 0);
  required_.clear();
  after_.assign(before);
  ensure(task_.apply(step, after_), "a planned step is possible");
  if (task_.evaluator().depends_on_calls(condition)) condition = freeze(condition, after_.words());

  if (task_.is_outcome(step)) {
    // The fluent must be sensed or known; learning it then gives this content whatever it was.
    const Task::SensingOutcome o = task_.outcome(step);
    const bool function = task_.layout().fluents()[o.fluent].function;
    required_.push_back(pool.leaf(function ? Kind::ValueKnown : Kind::Whether, o.fluent));
    touch(o.fluent, true);
  } else {
    const GroundAction& a = task_.action(step);
    required_.push_back(freeze(a.precondition, before));
    std::vector<Formula> fired, idle;
    for (const ConditionalEffect& c : a.effects) {
      const bool happens = task_.evaluator().holds(c.condition, before);
      // An effect that does not happen here must not happen, if it could touch what is asked for or
      // be an observation that contradicts what is known there; and where a call says so, this has
      // to find an answer, or the step is not possible.
      bool observes = false;
      const std::vector<Word> kept = touched_;
      const std::size_t requirements = required_.size();
      const auto touch_change = [&](const Change& change) {
        using K = Change::Kind;
        observes |=
            change.kind == K::AddGroup || change.kind == K::Exclude || change.kind == K::AddOptions;
        if (change.kind == K::AddGroup || change.kind == K::DeleteGroup) {
          for (const Index m : task_.layout().groups()[change.fluent].members) touch(m, false);
          const Group& group = task_.layout().groups()[change.fluent];
          for (Index w = 0; w < group.words(); ++w) touched_[group.word + w] = ~Word{0};
        } else {
          touch(change.fluent, change.kind == K::AddTrue || change.kind == K::AddFalse ||
                                   change.kind == K::AddValue || change.kind == K::Forget);
        }
      };
      if (!happens) touched_.assign(touched_.size(), 0);
      for (const Change& d : c.deletions) touch_change(d);
      for (const Change& d : c.additions) touch_change(d);
      for (const Change& d : c.sensing) touch_change(d);
      for (const ConditionalEffect::MaskedWrite& w : c.writes) touch_field(w.mask, w.word);
      for (const ConditionalEffect::Transfer& t : c.transfers)
        touch_transfer(t, happens, condition);
      if (happens) {
        fired.push_back(freeze(c.condition, before));
      } else {
        if (observes || overlaps(condition) || task_.evaluator().depends_on_calls(c.condition))
          idle.push_back(freeze(c.condition, before));
        touched_ = kept;
        required_.resize(requirements);
      }
    }
    required_.insert(required_.end(), fired.begin(), fired.end());
    required_.insert(required_.end(), idle.begin(), idle.end());
  }

  std::vector<Formula> conjuncts = {condition};
  if (pool.node(condition).kind == Kind::And)
    conjuncts.assign(pool.begin(condition), pool.end(condition));
  std::vector<Formula> result;
  for (const Formula c : conjuncts) {
    open_ = false;
    const Formula r = rewrite(c);
    ensure(r != kFalse || open_, "regression keeps the planned state");
    if (open_) {
      require_read(c);  // its truth rests on values still to be sensed: ask for the same knowledge
    } else {
      result.push_back(r);
    }
  }
  required_.insert(required_.end(), result.begin(), result.end());
  return pool.all(required_);
}

}  // namespace kaboum::plan
