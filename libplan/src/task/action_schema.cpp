// An action before it is ground: which conjuncts can be tested after each parameter, and which
// objects can stand for it.
#include "task/action_schema.h"

#include <algorithm>
#include <map>

#include "task/bindings.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kTabulated = 1U << 20U;             // entries of one table by arguments
constexpr std::size_t kNumbered = std::size_t{1} << 40U;  // times the objects of one type: a word

bool calls_external(const Query& q) {
  return q.kind == Query::Kind::External || q.kind == Query::Kind::Let ||
         std::any_of(q.children.begin(), q.children.end(), calls_external);
}

}  // namespace

ActionSchema::ActionSchema(const Action& action, const Model& model, const Layout& layout,
                           FormulaPool& pool, QueryGrounder& queries)
    : action_(&action), model_(&model), layout_(&layout), pool_(&pool), queries_(&queries) {
  levels_.resize(action.parameters.size());
  make_candidates(sort_conjuncts());
}

/// Gives each conjunct the level after which it can be tested; those of one parameter are returned
/// by parameter.
std::vector<std::vector<const Query*>> ActionSchema::sort_conjuncts() {
  std::vector<std::vector<const Query*>> singles(levels_.size());
  std::map<Index, Check> named;  // by the slot of a 'let': the conjunct that names it
  std::size_t latest = 0;  // a conjunct that calls an external function comes after all before it
  for (const Query* q : conjuncts(action_->precondition)) {
    Check c;
    c.query = q;
    for (const Index slot : free_slots(*q)) {
      const auto let = named.find(slot);
      if (let == named.end()) {
        c.slots.push_back(slot);
        continue;
      }
      const Check& by = let->second;
      c.slots.insert(c.slots.end(), by.slots.begin(), by.slots.end());
      c.lets.insert(c.lets.end(), by.lets.begin(), by.lets.end());
      c.lets.push_back(by.query);
    }
    std::sort(c.slots.begin(), c.slots.end());
    c.slots.erase(std::unique(c.slots.begin(), c.slots.end()), c.slots.end());
    if (q->kind == Query::Kind::Let) named.emplace(q->value->index, c);
    std::size_t depth = c.slots.empty() ? 0 : c.slots.back() + 1;
    const bool external = calls_external(*q);
    c.calls = external;
    if (external) depth = std::max(depth, latest);
    latest = std::max(latest, depth);
    if (depth == 0) {
      constant_.push_back(std::move(c));
    } else if (c.slots.size() == 1 && !external) {
      singles[depth - 1].push_back(q);
    } else {
      std::size_t entries = 1;
      for (const Index slot : c.slots) {
        entries *= model_->types[action_->parameters[slot].type].objects.size();
        if (entries > kTabulated) break;
      }
      if (entries <= kTabulated) c.grounded.assign(entries, kNotGrounded);
      levels_[depth - 1].checks.push_back(std::move(c));
    }
  }
  return singles;
}

void ActionSchema::make_candidates(const std::vector<std::vector<const Query*>>& singles) {
  std::vector<Index> slots(std::max<Index>(action_->slots, 1), 0);
  std::size_t instances = 1;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const std::vector<Index>& objects = model_->types[action_->parameters[i].type].objects;
    for (const Index o : objects) {
      Candidate c;
      c.object = o;
      slots[i] = o;
      std::vector<Formula> all;
      for (const Query* q : singles[i]) all.push_back(queries_->ground(*q, slots));
      c.full = pool_->all(all);
      if (c.full == kFalse) continue;
      c.test = pool_->as_bits(c.full).value_or(BitTest{});
      levels_[i].candidates.push_back(c);
    }
    if (instances <= kNumbered) instances *= std::max<std::size_t>(objects.size(), 1);
  }
  numbered_ = instances <= kNumbered;
  if (instances <= kTabulated) ids_.assign(instances, kNoOperator);
}

Formula ActionSchema::ground(const Check& check, const Index* slots) {
  std::vector<Index> copy(slots, slots + std::max<Index>(action_->slots, 1));
  for (const Query* let : check.lets) queries_->ground(*let, copy);
  return queries_->ground(*check.query, copy);
}

OperatorId& ActionSchema::id(const std::vector<Index>& arguments) {
  if (!ids_.empty()) return ids_[number_of(arguments)];
  if (numbered_) return id_by_number_.emplace(number_of(arguments), kNoOperator).first->second;
  std::string key;
  for (const Index o : arguments) key.append(reinterpret_cast<const char*>(&o), sizeof o);
  return id_by_arguments_.emplace(key, kNoOperator).first->second;
}

std::uint64_t ActionSchema::number_of(const std::vector<Index>& arguments) const {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Index type = action_->parameters[i].type;
    n = n * model_->types[type].objects.size() + layout_->position(type, arguments[i]);
  }
  return n;
}

}  // namespace kaboum::plan
