// Grounding of effects: updates of the databases become changes of fluents, grouped by condition.
#include "task/effect_grounder.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <utility>

#include "task/bindings.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumUpdates = 1'000'000;  // of one ground action

}  // namespace

void EffectGrounder::ground(std::vector<Index>& slots, GroundAction& action) {
  updates_ = 0;
  ground(model_.actions[action.schema].effects, kTrue, slots, action);
}

void EffectGrounder::ground(const std::vector<Effect>& effects, Formula condition,
                            std::vector<Index>& slots, GroundAction& action) {
  for (const Effect& e : effects) {
    switch (e.kind) {
      case Effect::Kind::Update: {
        limits_.work(sizeof(Change));
        if (++updates_ > kMaximumUpdates)
          throw Error(
              ErrorCode::LimitReached,
              "the effects of an action '" + model_.actions[action.schema].name + "' are too many");
        if (action.effects.empty() || action.effects.back().condition != condition) {
          ConditionalEffect c;
          c.condition = condition;
          c.test = pool_.as_bits(condition).value_or(BitTest{});
          action.effects.push_back(std::move(c));
        }
        add_update(e.update, slots, action);
        break;
      }
      case Effect::Kind::When: {
        limits_.work();
        const Formula f = pool_.all({condition, queries_.ground(e.condition, slots)});
        if (f != kFalse) ground(e.children, f, slots, action);
        break;
      }
      case Effect::Kind::ForAll:
        for (const Index o : model_.types[e.type].objects) {
          slots[e.slot] = o;
          ground(e.children, condition, slots, action);
        }
        break;
    }
  }
}

Layout::Field EffectGrounder::field(const Update::Literal& l,
                                    const std::vector<Index>& slots) const {
  std::vector<Index> objects;
  for (const Argument& a : l.arguments) objects.push_back(value_of(a, slots.data()));
  return l.function ? layout_.term(l.symbol, objects.data())
                    : layout_.atom(l.symbol, objects.data());
}

Index EffectGrounder::position(const Update::Literal& l, const std::vector<Index>& slots) const {
  return layout_.position(model_.functions[l.symbol].range, queries_.operand(*l.value, slots));
}

bool EffectGrounder::is_transferred(Index fluent, const GroundAction& action) {
  return std::ranges::any_of(action.effects, [&](const ConditionalEffect& c) {
    return std::ranges::any_of(c.transfers, [&](const auto& t) { return t.fluent == fluent; });
  });
}

void EffectGrounder::add_update(const Update& u, const std::vector<Index>& slots,
                                GroundAction& action) {
  ConditionalEffect& out = action.effects.back();
  const Update::Literal& l = u.literals[0];
  const Layout::Field at = field(l, slots);
  if (!at.exists) return;  // an argument outside its type: no such atom
  ensure(at.fluent != kNone, "an effect changes what was taken for constant");
  if (l.value && l.function && layout_.fluents()[at.fluent].handle) {
    if (u.maybe) {  // it is not known then
      out.transfers.push_back({at.fluent, kNone});
      return;
    }
    const Index o = queries_.operand(*l.value, slots);
    if (is_call(o) || is_term(o)) {
      out.transfers.push_back({at.fluent, o});
      return;
    }
    // A term that is never known makes this one unknown. Writes come before transfers: after a
    // transfer to this term, a value is one as well.
    if (o == kNone || is_transferred(at.fluent, action)) {
      out.transfers.push_back({at.fluent, o});
      return;
    }
  }
  if (l.value && position(l, slots) == kNone) return;
  Change c = change_of(u, slots, at.fluent);
  using K = Change::Kind;
  if (!u.add) {
    out.deletions.push_back(std::move(c));
  } else if (c.kind == K::AddWhether || c.kind == K::AddSensed || c.kind == K::AddClosed) {
    out.sensing.push_back(std::move(c));
  } else if (out.additions.empty() && is_direct(c)) {
    add_write(c, out);
  } else {
    // A direct write after other additions would come before them: the text's order is kept.
    out.additions.push_back(std::move(c));
  }
}

Change EffectGrounder::change_of(const Update& u, const std::vector<Index>& slots,
                                 Index fluent) const {
  using K = Change::Kind;
  const Update::Literal& l = u.literals[0];
  Change c;
  c.fluent = fluent;
  switch (u.database) {
    case Update::Database::Kf:
      if (l.function) c.value = position(l, slots);
      if (u.add && !u.maybe) {
        c.kind = l.function ? (l.negated ? K::Exclude : K::AddValue)
                            : (l.negated ? K::AddFalse : K::AddTrue);
      } else {
        // What may happen takes the knowledge that it would make false: the negation.
        const bool takes_negation = l.negated != u.maybe;
        c.kind = l.function ? (takes_negation ? K::DeleteExclude : K::DeleteValue)
                            : (takes_negation ? K::DeleteFalse : K::DeleteTrue);
      }
      break;
    case Update::Database::Kw:
      c.kind = u.add ? K::AddWhether : K::Forget;
      break;
    case Update::Database::Kv:
      c.kind = u.add ? K::AddSensed : K::Forget;
      break;
    case Update::Database::Lcw:
      c.kind = u.add ? K::AddClosed : K::DeleteClosed;
      break;
    case Update::Database::Kx:
      return exclusive_change(u, slots, fluent);
    case Update::Database::Or:
      break;  // of initial entries only
  }
  return c;
}

/// Of Kx: the possible values of one term, or a group of atoms.
Change EffectGrounder::exclusive_change(const Update& u, const std::vector<Index>& slots,
                                        Index fluent) const {
  using K = Change::Kind;
  Change c;
  c.fluent = fluent;
  if (u.literals[0].function) {
    c.kind = u.add ? K::AddOptions : K::Forget;
    for (const Update::Literal& o : u.literals)
      if (const Index p = position(o, slots); p != kNone) c.options.push_back(p);
    return c;
  }
  std::vector<Index> members;
  for (const Update::Literal& o : u.literals) members.push_back(field(o, slots).fluent);
  c.kind = u.add ? K::AddGroup : K::DeleteGroup;
  c.fluent = layout_.group(std::move(members));
  ensure(c.fluent != kNone, "an effect names an unknown group");
  return c;
}

/// Whether the change only writes its field.
bool EffectGrounder::is_direct(const Change& c) const {
  if (c.kind != Change::Kind::AddTrue && c.kind != Change::Kind::AddFalse &&
      c.kind != Change::Kind::AddValue)
    return false;
  const Fluent& f = layout_.fluents()[c.fluent];
  return f.groups.empty() && f.exclusions == kNone;
}

/// Writes to one word are one write.
void EffectGrounder::add_write(const Change& c, ConditionalEffect& out) const {
  const Fluent& f = layout_.fluents()[c.fluent];
  const Word content =
      c.kind == Change::Kind::AddValue
          ? kFirstValue + c.value
          : static_cast<Word>(c.kind == Change::Kind::AddTrue ? AtomKnowledge::True
                                                              : AtomKnowledge::False);
  const ConditionalEffect::MaskedWrite w{f.word, f.mask, content << f.shift};
  out.direct.push_back(c);
  for (ConditionalEffect::MaskedWrite& old : out.writes)
    if (old.word == w.word) {
      old.bits = (old.bits & ~w.mask) | w.bits;
      old.mask |= w.mask;
      return;
    }
  out.writes.push_back(w);
}

}  // namespace kaboum::plan
