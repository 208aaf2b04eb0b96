// A planning task: ground actions as they are first reached, and what they make of a state.
#include "task/task.h"

#include <kaboum/base/error.h>

#include <algorithm>

#include "task/bindings.h"
#include "task/ground_text.h"
#include "task/initial_knowledge.h"
#include "task/sensing.h"

namespace kaboum::plan {

Task::Task(const Model& model, Limits& limits)
    : model_(model),
      limits_(limits),
      layout_(model, limits),
      calls_(model, layout_, limits),
      pool_(layout_, limits),
      derived_(pool_, layout_),
      evaluator_(pool_, layout_, calls_, derived_),
      queries_(model, layout_, limits, pool_, calls_, derived_),
      grounder_(model, layout_, pool_, queries_, limits),
      effects_(layout_, evaluator_, calls_) {
  Index slots = std::max<Index>(model.goal_slots, 1);
  for (const Action& a : model.actions) slots = std::max(slots, a.slots);
  slots_.assign(slots, 0);
  schemas_.reserve(model.actions.size());
  for (const Action& a : model.actions) schemas_.emplace_back(a, model, layout_, pool_, queries_);
  goal_ = queries_.ground(model.goal, slots_);
  initial_ = initial_knowledge(model, layout_);
  if (layout_.sensing()) sensible_ = sensible_fluents(model, layout_);
}

OperatorId Task::action_id(Index schema, const std::vector<Index>& arguments) {
  OperatorId& known = schemas_[schema].id(arguments);
  if (known != kNoOperator) return known;
  if (actions_.size() >= OutcomeTable::kFirst - 1)
    throw Error(ErrorCode::LimitReached, "too many ground actions");
  const Action& a = model_.actions[schema];
  auto ground = std::make_unique<GroundAction>();
  ground->schema = schema;
  ground->arguments = arguments;
  std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
  std::copy(arguments.begin(), arguments.end(), slots.begin());
  ground->precondition = queries_.ground(a.precondition, slots);
  ground->cost = cost_of(a, slots);
  for (const Query* q : conjuncts(a.precondition))
    if (q->kind == Query::Kind::Let && is_call(slots[q->value->index]))
      ground->lets.push_back(slots[q->value->index] & ~kCallOperand);
  grounder_.ground(slots, *ground);
  for (const ConditionalEffect& c : ground->effects)
    ground->conditions_call |= pool_.node(c.condition).calls;
  ground->asks = evaluator_.depends_on_calls(ground->precondition);
  for (const ConditionalEffect& c : ground->effects) {
    ground->asks |= evaluator_.depends_on_calls(c.condition);
    for (const ConditionalEffect::Transfer& t : c.transfers)
      ground->asks |= is_call(t.operand) && calls_.depends_on_state(t.operand & ~kCallOperand);
  }
  limits_.work(sizeof(GroundAction) + ground->effects.size() * sizeof(ConditionalEffect));
  known = static_cast<OperatorId>(actions_.size());
  actions_.push_back(std::move(ground));
  return known;
}

std::int64_t Task::cost_of(const Action& a, const std::vector<Index>& slots) const {
  if (a.cost_function == kNone) return a.cost;
  std::vector<Index> objects;
  for (const Argument& c : a.cost_arguments) objects.push_back(value_of(c, slots.data()));
  const auto& table = model_.numbers[a.cost_function];
  const auto value = table.find(objects);
  if (value == table.end())
    throw Error(ErrorCode::InvalidInput,
                "no initial value of '" +
                    ground_text(model_, model_.functions[a.cost_function].name, objects) +
                    "' for the cost of an action '" + a.name + "'");
  return value->second;
}

std::vector<Index> Task::outcomes(Index fluent, const Word* state) const {
  const Fluent& f = layout_.fluents()[fluent];
  if (!f.function) return {1, 0};
  Knowledge k(layout_);
  k.assign(state);
  return k.possible_values(fluent, layout_.range_size(f));
}

bool Task::apply(OperatorId step, Knowledge& state) {
  if (is_outcome(step)) {
    const SensingOutcome o = outcomes_[step];
    return layout_.fluents()[o.fluent].function ? state.learn_value(o.fluent, o.value)
                                                : state.learn_atom(o.fluent, o.value != 0);
  }
  return effects_.make(*actions_[step], state, false);
}

bool Task::suppose(OperatorId step, Knowledge& state) {
  return !actions_[step]->conditions_call && effects_.make(*actions_[step], state, true);
}

}  // namespace kaboum::plan
