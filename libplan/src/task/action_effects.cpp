// What an action makes of a state.
#include "task/action_effects.h"

#include <array>

namespace kaboum::plan {

/// @return false: a call has no value.
bool ActionEffects::take(const ConditionalEffect::Transfer& t, const Word* state, bool supposed) {
  if (t.operand == kNone) {
    taken_.emplace_back(t.fluent, kValueUnknown);
    return true;
  }
  if (!is_call(t.operand) && !is_term(t.operand)) {
    taken_.emplace_back(t.fluent, kFirstValue + t.operand);
    return true;
  }
  if (is_term(t.operand)) {
    taken_.emplace_back(t.fluent, layout_.fluents()[t.operand & ~kTermOperand].get(state));
    return true;
  }
  if (supposed) {
    taken_.emplace_back(t.fluent, kValueUnknown);
    return true;
  }
  const ExternalCalls::Reply reply = calls_.evaluate(t.operand & ~kCallOperand, state);
  if (reply.kind != ExternalCalls::Reply::Kind::Value) return false;
  taken_.emplace_back(t.fluent, kFirstValue + reply.value);
  return true;
}

bool ActionEffects::make(const GroundAction& a, Knowledge& state, bool supposed) {
  taken_.clear();
  // All conditions, and terms and calls, look at the state before the action; then come deletions,
  // additions, sensing.
  std::array<const ConditionalEffect*, 16> few;
  std::vector<const ConditionalEffect*> many;
  std::size_t count = 0;
  bool deletions = false;
  for (const ConditionalEffect& c : a.effects) {
    if (c.condition != kTrue) {
      if (c.test.mask != 0) {
        if (!c.test.holds(state.words())) continue;
      } else if (!evaluator_.holds(c.condition, state.words())) {
        continue;
      }
    }
    deletions |= !c.deletions.empty();
    for (const ConditionalEffect::Transfer& t : c.transfers)
      if (!take(t, state.words(), supposed)) return false;
    if (count < few.size()) {
      few[count] = &c;
    } else {
      if (many.empty()) many.assign(few.begin(), few.end());
      many.push_back(&c);
    }
    ++count;
  }
  const ConditionalEffect* const* fired = many.empty() ? few.data() : many.data();
  if (deletions)
    for (std::size_t i = 0; i < count; ++i)
      for (const Change& c : fired[i]->deletions)
        if (!state.apply(c)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    for (const ConditionalEffect::MaskedWrite& w : fired[i]->writes)
      state.write(w.word, w.mask, w.bits);
    for (const Change& c : fired[i]->additions)
      if (!state.apply(c)) return false;
  }
  for (const auto& [fluent, content] : taken_) {
    const Fluent& f = layout_.fluents()[fluent];
    state.write(f.word, f.mask, content << f.shift);
  }
  // What is sensed is the world after the action.
  for (std::size_t i = 0; i < count; ++i)
    for (const Change& c : fired[i]->sensing)
      if (!state.apply(c)) return false;
  return true;
}

}  // namespace kaboum::plan
