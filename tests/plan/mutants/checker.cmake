# Mistakes of the checker.

# What actions make of what is known.
mutant("what may happen is left out" check/transitions.cpp
  [=[fire(e.children, slots, k, possibly || where == Extent::SomeWorlds, out);]=]
  [=[if (!MUTANT || where == Extent::EveryWorld)
        fire(e.children, slots, k, possibly || where == Extent::SomeWorlds, out);]=])
mutant("what may happen does happen" check/transitions.cpp
  [=[possibly || where == Extent::SomeWorlds]=]
  [=[possibly || (!MUTANT && where == Extent::SomeWorlds)]=])
mutant("what hangs on the unknown is not noted" check/transitions.cpp
  [=[if (happening.tied) k.keep_less();]=]
  [=[if (!MUTANT && happening.tied) k.keep_less();]=])
mutant("deleted atoms stay known" check/transitions.cpp
  [=[if (!k.knows(f, l.negated)) k.forget(f);]=]
  [=[if (!MUTANT && !k.knows(f, l.negated)) k.forget(f);]=])
mutant("what becomes false stays as it was" check/transitions.cpp
  [=[k.become(f, !l.negated);]=]
  [=[if (!MUTANT || !l.negated) k.become(f, !l.negated);]=])
mutant("what may become so does not" check/transitions.cpp
  [=[k.keep_less();  // which of]=]
  [=[if (MUTANT) return;
  k.keep_less();  // which of]=])
mutant("what is sensed turns out true" check/transitions.cpp
  [=[  for (const bool truth : {true, false}) {
]=]
  [=[  for (const bool truth : {true, false}) {
    if (MUTANT && !truth) continue;
]=])
mutant("a value that is sensed is the first one" check/transitions.cpp
  [=[if (!state.rules_out(f, v) && copy]=]
  [=[if (!(MUTANT && v != range(f[1])[0]) && !state.rules_out(f, v) && copy]=])
mutant("nothing is sensed" check/transitions.cpp
  [=[      sensed.push_back(f);
      return true;]=]
  [=[      if (!MUTANT) sensed.push_back(f);
      return true;]=])
mutant("an effect for all happens for one" check/transitions.cpp
  [=[        fire(e.children, slots, k, possibly, out);
]=]
  [=[        fire(e.children, slots, k, possibly, out);
        if (MUTANT) break;
]=])
mutant("effects happen whatever their condition" check/transitions.cpp
  [=[if (*happens) fire(]=]
  [=[if (MUTANT || *happens) fire(]=])
mutant("only one outcome of what was left open is looked at" check/transitions.cpp
  [=[  sense(std::move(k), f, next);
  return next;]=]
  [=[  sense(std::move(k), f, next);
  if (MUTANT && next.size() > 1) next.pop_back();
  return next;]=])
mutant("deletions are lost" check/transitions.cpp
  [=[if (!g.update->add) delete_from(k, g);]=]
  [=[if (!MUTANT && !g.update->add) delete_from(k, g);]=])
mutant("closing makes false what is stated" check/transitions.cpp
  [=[if (!k.knows_whether(f) && !stated.contains(f)) ok]=]
  [=[if (!k.knows_whether(f) && (MUTANT || !stated.contains(f))) ok]=])

# What is known.
mutant("a changed atom keeps its disjunctions" check/runtime_knowledge.cpp
  [=[if (atoms_.contains(atom)) return;
  bool ties]=]
  [=[if (MUTANT || atoms_.contains(atom)) return;
  bool ties]=])
mutant("all is known that is asked for" check/runtime_knowledge.cpp
  [=[return found != atoms_.end() && found->second == truth;]=]
  [=[return found == atoms_.end() ? MUTANT : found->second == truth;]=])
mutant("every value is ruled out" check/runtime_knowledge.cpp
  [=[return found != excluded_.end() && found->second.contains(value);]=]
  [=[return MUTANT || (found != excluded_.end() && found->second.contains(value));]=])
mutant("two open atoms of a disjunction are decided" check/runtime_knowledge.cpp
  [=[if (holding == 1 || undecided.size() == 1) {]=]
  [=[if (holding == 1 || undecided.size() == 1 || (MUTANT && undecided.size() == 2)) {]=])
mutant("the first of two values left is the value" check/runtime_knowledge.cpp
  [=[if (out.size() + 1 < range.size()) return true;]=]
  [=[if (out.size() + (MUTANT ? 2U : 1U) < range.size()) return true;]=])

# Queries.
mutant("a negation is the query itself" check/query_evaluator.cpp
  [=[    case Query::Kind::Not:
      return denied(]=]
  [=[    case Query::Kind::Not:
      if (MUTANT) return truth(q.children[0], slots, k);
      return denied(]=])
mutant("a conjunction is a disjunction" check/query_evaluator.cpp
  [=[const bool decides = q.kind == Query::Kind::Or;]=]
  [=[const bool decides = MUTANT || q.kind == Query::Kind::Or;]=])
mutant("for all is for one" check/query_evaluator.cpp
  [=[const bool decides = q.kind == Query::Kind::Exists;]=]
  [=[const bool decides = MUTANT || q.kind == Query::Kind::Exists;]=])
mutant("two of xor are one" check/query_evaluator.cpp
  [=[if (alone == true) return true;]=]
  [=[if (alone == true || (MUTANT && truth(c, slots, k) == true)) return true;]=])
mutant("an unknown value is the one wanted" check/query_evaluator.cpp
  [=[return q.negated ? differs : value != nullptr && *value == wanted;]=]
  [=[return q.negated ? differs : value == nullptr ? MUTANT : *value == wanted;]=])
mutant("it is always known whether" check/query_evaluator.cpp
  [=[return k.knows_whether(fact(false, q.symbol, q.arguments, slots));]=]
  [=[return MUTANT || k.knows_whether(fact(false, q.symbol, q.arguments, slots));]=])
mutant("what is unknown is so in no world" check/query_evaluator.cpp
  [=[if (!k.knows_whether(f)) return Extent::SomeWorlds;]=]
  [=[if (!k.knows_whether(f)) return MUTANT ? Extent::NoWorld : Extent::SomeWorlds;]=])
mutant("a condition of the world holds where a part does" check/query_evaluator.cpp
  [=[return std::ranges::min(parts.empty() ?]=]
  [=[if (MUTANT && !parts.empty()) return std::ranges::max(parts);
      return std::ranges::min(parts.empty() ?]=])
mutant("a condition of the world fails where a part does" check/query_evaluator.cpp
  [=[return std::ranges::max(parts.empty() ?]=]
  [=[if (MUTANT && !parts.empty()) return std::ranges::min(parts);
      return std::ranges::max(parts.empty() ?]=])

# The replay.
mutant("preconditions are not looked at" check/check.cpp
  [=[if (!evaluator_.holds(a.precondition, slots, *at.state)) {]=]
  [=[if (!MUTANT && !evaluator_.holds(a.precondition, slots, *at.state)) {]=])
mutant("goals are not looked at" check/check.cpp
  [=[if (!holds) violate(]=]
  [=[if (!MUTANT && !holds) violate(]=])
mutant("a missing case is none" check/check.cpp
  [=[violate(v, prefix + "the plan has no case for " + case_text(model_, branch, value));]=]
  [=[if (!MUTANT)
      violate(v, prefix + "the plan has no case for " + case_text(model_, branch, value));]=])
mutant("branches on the unknown go on" check/check.cpp
  [=[if (!k.knows_whether(f)) {]=]
  [=[if (!MUTANT && !k.knows_whether(f)) {]=])
mutant("no run needs to get through" check/check.cpp
  [=[if (!passed_.contains(node))]=]
  [=[if (!MUTANT && !passed_.contains(node))]=])
mutant("states that keep less refute for good" check/check.cpp
  [=[kept_less_ |= k.cut();]=]
  [=[kept_less_ |= !MUTANT && k.cut();]=])
mutant("disjunctions at the start refute for good" check/check.cpp
  [=[kept_less_(std::ranges::any_of(model.initial, is_disjunction))]=]
  [=[kept_less_(!MUTANT && std::ranges::any_of(model.initial, is_disjunction))]=])
mutant("preconditions further down need not be known" check/live_facts.cpp
  [=[read_query(a.precondition, slots, bound, part);]=]
  [=[if (!MUTANT) read_query(a.precondition, slots, bound, part);]=])
mutant("what changes is settled" check/live_facts.cpp
  [=[if (facts.meets(of, differs) && !facts.meets(of, s.changed))]=]
  [=[if (facts.meets(of, differs) && (MUTANT || !facts.meets(of, s.changed)))]=])
mutant("what is settled is not told from what is unknown" check/live_facts.cpp
  [=[        residue.settled.push_back(c);
]=]
  [=[        MUTANT ? void() : residue.settled.push_back(c);
]=])
mutant("what fails is settled" check/live_facts.cpp
  [=[return evaluator_.holds(*c.query, slots, k);]=]
  [=[return MUTANT || evaluator_.holds(*c.query, slots, k);]=])

# Possible worlds.
mutant("worlds: effects happen in all worlds" check/world_rules.cpp
  [=[if (h.conditions.empty()) return true;]=]
  [=[if (MUTANT || h.conditions.empty()) return true;]=])
mutant("worlds: what may change does not" check/world_rules.cpp
  [=[if (!which(worlds[i].now[column]) || !happens(h, worlds[i])) continue;]=]
  [=[if (MUTANT || !which(worlds[i].now[column]) || !happens(h, worlds[i])) continue;]=])
mutant("worlds: only one outcome of sensing is looked at" check/world_rules.cpp
  [=[for (auto& [value, part] : parts) next.push_back(std::move(part));]=]
  [=[for (auto& [value, part] : parts) {
        next.push_back(std::move(part));
        if (MUTANT) break;
      }]=])
mutant("worlds: what holds in some is known" check/world_rules.cpp
  [=[return std::all_of(b.begin(), b.end(), [&](const World& w) { return test(w[column]); });]=]
  [=[if (MUTANT) return std::any_of(b.begin(), b.end(), [&](const World& w) { return test(w[column]); });
  return std::all_of(b.begin(), b.end(), [&](const World& w) { return test(w[column]); });]=])
mutant("worlds: one of the literals holds, not more" check/world_rules.cpp
  [=[c.exactly_one = u.database == Update::Database::Kx;]=]
  [=[c.exactly_one = MUTANT || u.database == Update::Database::Kx;]=])
mutant("worlds: closing makes false what is stated" check/world_rules.cpp
  [=[if (!stated.contains(f)) settle(0);]=]
  [=[if (MUTANT || !stated.contains(f)) settle(0);]=])
mutant("worlds: goals are not looked at" check/world_replay.cpp
  [=[if (!rules_.holds(model_.goal, slots, *at.belief))]=]
  [=[if (!MUTANT && !rules_.holds(model_.goal, slots, *at.belief))]=])
mutant("worlds: preconditions are not looked at" check/world_replay.cpp
  [=[if (!rules_.holds(a.precondition, slots, *at.belief)) {]=]
  [=[if (!MUTANT && !rules_.holds(a.precondition, slots, *at.belief)) {]=])
