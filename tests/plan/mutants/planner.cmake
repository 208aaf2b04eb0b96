# Mistakes of the planner that lead to wrong plans.

# Conditional effects and disjunctions as the databases keep them.
mutant("what may happen is left out" task/knowledge_view.cpp
  [=[open.children = possibly(std::move(open.children));]=]
  [=[open.children = MUTANT ? std::vector<Effect>{} : possibly(std::move(open.children));]=])
mutant("what may happen does happen" task/knowledge_view.cpp
  [=[e.update.maybe = e.update.add;]=]
  [=[e.update.maybe = !MUTANT && e.update.add;]=])
mutant("what may be deleted stays known" task/knowledge_view.cpp
  [=[if (e.update.add && e.update.database != Update::Database::Kf) continue;]=]
  [=[if (MUTANT && !e.update.add) continue;
      if (e.update.add && e.update.database != Update::Database::Kf) continue;]=])
mutant("conditions of the world are taken for granted" task/knowledge_view.cpp
  [=[known.of_world = false;]=]
  [=[known.of_world = false;
    if (MUTANT && e.of_world) known.condition = {};]=])
mutant("closing makes atoms of Or false" task/knowledge_view.cpp
  [=[stated.contains(key(u.literals[0])]=]
  [=[!MUTANT && stated.contains(key(u.literals[0])]=])

# Updates of knowledge, and what is left as it was.
mutant("a changed atom keeps its disjunctions" task/knowledge.cpp
  [=[if (!f.groups.empty()) drop_groups(f);]=]
  [=[if (!MUTANT && !f.groups.empty()) drop_groups(f);]=])
mutant("what is deleted stays known to be true" task/knowledge.cpp
  [=[    case K::DeleteTrue:
]=]
  [=[    case K::DeleteTrue:
      if (MUTANT) break;
]=])
mutant("what is deleted stays known to be false" task/knowledge.cpp
  [=[    case K::DeleteFalse:
]=]
  [=[    case K::DeleteFalse:
      if (MUTANT) break;
]=])
mutant("what is forgotten stays known" task/knowledge.cpp
  [=[    case K::Forget:
]=]
  [=[    case K::Forget:
      if (MUTANT) break;
]=])
mutant("a deleted value stays known" task/knowledge.cpp
  [=[    case K::DeleteValue:
]=]
  [=[    case K::DeleteValue:
      if (MUTANT) break;
]=])
mutant("two open atoms of a disjunction are decided" task/knowledge.cpp
  [=[if (holding == 1 || open.size() == 1) {]=]
  [=[if (holding == 1 || open.size() == 1 || (MUTANT && open.size() == 2)) {]=])
mutant("the first of two values left is the value" task/knowledge.cpp
  [=[if (excluded_count + 1 < range) return true;]=]
  [=[if (excluded_count + (MUTANT ? 2U : 1U) < range) return true;]=])

# Sensing.
mutant("what is sensed turns out true" task/knowledge.cpp
  [=[set(c.fluent, raw(AtomKnowledge::Whether));
        std::vector]=]
  [=[set(c.fluent, raw(MUTANT ? AtomKnowledge::True : AtomKnowledge::Whether));
        std::vector]=])
mutant("a value that is sensed is the first one" task/knowledge.cpp
  [=[if (now == kValueUnknown) set(c.fluent, kValueSensed);]=]
  [=[if (now == kValueUnknown) set(c.fluent, MUTANT ? kFirstValue : kValueSensed);]=])
mutant("what is sensed at the start is true" task/initial_knowledge.cpp
  [=[return knowledge_.apply({Change::Kind::AddWhether, p.fluent, 0, {}});]=]
  [=[return MUTANT ? knowledge_.learn_atom(p.fluent, true)
                      : knowledge_.apply({Change::Kind::AddWhether, p.fluent, 0, {}});]=])
mutant("closing makes atoms of Kx false" task/initial_knowledge.cpp
  [=[stated_.contains(p.fluent) ||]=]
  [=[(!MUTANT && stated_.contains(p.fluent)) ||]=])
mutant("effects do not wait for what is sensed" task/successors.cpp
  [=[if constexpr (Sensing) return decided(action);]=]
  [=[if constexpr (Sensing) return MUTANT || decided(action);]=])

# Preconditions and goals.
mutant("what is sensed is as it is wanted" task/formula_evaluator.cpp
  [=[if (k == AtomKnowledge::Whether || tied(n.a, k, state)) return Truth::Open;]=]
  [=[if (k == AtomKnowledge::Whether || tied(n.a, k, state))
        return MUTANT ? Truth::Yes : Truth::Open;]=])
mutant("what is not known to be true is false" task/formula_evaluator.cpp
  [=[return yes(k == (n.kind == Kind::IsTrue ? AtomKnowledge::True : AtomKnowledge::False));]=]
  [=[if (MUTANT && n.kind == Kind::IsFalse) return yes(k != AtomKnowledge::True);
      return yes(k == (n.kind == Kind::IsTrue ? AtomKnowledge::True : AtomKnowledge::False));]=])
mutant("an unknown value is the one wanted" task/formula_evaluator.cpp
  [=[if (v == kValueUnknown || excluded(fluent, state, n.b)) return Truth::No;]=]
  [=[if (MUTANT && v == kValueUnknown) return Truth::Yes;
      if (v == kValueUnknown || excluded(fluent, state, n.b)) return Truth::No;]=])
mutant("an unknown value is another one" task/formula_evaluator.cpp
  [=[return v == kValueSensed ? Truth::Open : Truth::No;]=]
  [=[return v == kValueSensed ? Truth::Open : MUTANT ? Truth::Yes : Truth::No;]=])
mutant("it is always known whether" task/formula_evaluator.cpp
  [=[yes(k != AtomKnowledge::Unknown);]=]
  [=[yes(MUTANT || k != AtomKnowledge::Unknown);]=])
mutant("every value is known" task/formula_evaluator.cpp
  [=[return yes(layout_.fluents()[n.a].get(state) != kValueUnknown);]=]
  [=[return yes(MUTANT || layout_.fluents()[n.a].get(state) != kValueUnknown);]=])
mutant("of a conjunction only the first part is looked at" task/formula_evaluator.cpp
  [=[if (t == decides) return t;]=]
  [=[if (t == decides || (MUTANT && all)) return t;]=])
mutant("two of xor are one" task/formula_evaluator.cpp
  [=[if (certain > 1) return Truth::No;]=]
  [=[if (certain > 1) return MUTANT ? Truth::Yes : Truth::No;]=])
mutant("every negation holds" task/formula_evaluator.cpp
  [=[return yes(t == Truth::No && ]=]
  [=[return yes((MUTANT || t == Truth::No) && ]=])
mutant("for all is for one" task/query_grounder.cpp
  [=[return exists ? pool_.any(children)]=]
  [=[return exists || MUTANT ? pool_.any(children)]=])
mutant("negations of atoms are not seen" task/query_grounder.cpp
  [=[return pool_.leaf(q.negated ? Kind::IsFalse : Kind::IsTrue, p.fluent);]=]
  [=[return pool_.leaf(q.negated && !MUTANT ? Kind::IsFalse : Kind::IsTrue, p.fluent);]=])

# Effects.
mutant("effects happen whatever their condition" task/effect_grounder.cpp
  [=[ground(e.children, f, slots, action);]=]
  [=[ground(e.children, MUTANT ? condition : f, slots, action);]=])
mutant("an effect for all happens for one" task/effect_grounder.cpp
  [=[          ground(e.children, condition, slots, action);
]=]
  [=[          ground(e.children, condition, slots, action);
          if (MUTANT) break;
]=])
mutant("deletions are lost" task/effect_grounder.cpp
  [=[    out.deletions.push_back(std::move(c));]=]
  [=[    if (!MUTANT) out.deletions.push_back(std::move(c));]=])
mutant("what becomes false stays as it was" task/effect_grounder.cpp
  [=[if (l.value && position(l, slots) == kNone) return;]=]
  [=[if (MUTANT && u.add && !u.maybe && !l.function && l.negated) return;
  if (l.value && position(l, slots) == kNone) return;]=])
mutant("what may become so does not" task/effect_grounder.cpp
  [=[if (l.value && position(l, slots) == kNone) return;]=]
  [=[if (MUTANT && u.maybe) return;
  if (l.value && position(l, slots) == kNone) return;]=])

# Branches, and sub-plans that are used for other states than theirs.
mutant("other outcomes are forgotten" search/contingent.cpp
  [=[if (!expects(at.data(), other)) continue;]=]
  [=[if (MUTANT || !expects(at.data(), other)) continue;]=])
mutant("a sub-plan is used where its first precondition fails" search/regression.cpp
  [=[required_.push_back(freeze(a.precondition, before));]=]
  [=[if (!MUTANT) required_.push_back(freeze(a.precondition, before));]=])
mutant("a sub-plan is used where what it leaves alone differs" search/regression.cpp
  [=[if (!leaf_touched(pool, task_.layout(), f, touched_)) return f;]=]
  [=[if (!leaf_touched(pool, task_.layout(), f, touched_)) return MUTANT ? kTrue : f;]=])
mutant("a sub-plan is used where its effects do not happen" search/regression.cpp
  [=[required_.insert(required_.end(), fired.begin(), fired.end());]=]
  [=[if (!MUTANT) required_.insert(required_.end(), fired.begin(), fired.end());]=])
mutant("a sub-plan is used where other effects happen" search/regression.cpp
  [=[required_.insert(required_.end(), idle.begin(), idle.end());]=]
  [=[if (!MUTANT) required_.insert(required_.end(), idle.begin(), idle.end());]=])

# Sets of possible worlds.
mutant("worlds: effects happen in all worlds" worlds/belief_space.cpp
  [=[return holds_in(s.world, common, sets.contents(w.origin));]=]
  [=[return MUTANT || holds_in(s.world, common, sets.contents(w.origin));]=])
mutant("worlds: what may change does not" worlds/belief_space.cpp
  [=[if (!happens(worlds[i]) || !which(worlds[i])) continue;]=]
  [=[if (MUTANT || !happens(worlds[i]) || !which(worlds[i])) continue;]=])
mutant("worlds: what holds in some is known" worlds/belief_space.cpp
  [=[if (c.kind == Kind::Is || c.kind == Kind::Decided) return false;]=]
  [=[if (c.kind == Kind::Is || c.kind == Kind::Decided) return MUTANT;]=])
mutant("worlds: only one outcome of sensing is planned for" worlds/belief_space.cpp
  [=[if (part.empty()) continue;]=]
  [=[if (part.empty() || (MUTANT && value > 0)) continue;]=])
mutant("worlds: one of the literals holds, not more" worlds/world_grounder.cpp
  [=[c.exactly_one = u.database == Update::Database::Kx;]=]
  [=[c.exactly_one = MUTANT || u.database == Update::Database::Kx;]=])
mutant("worlds: closing makes atoms of disjunctions false" worlds/world_grounder.cpp
  [=[if (!stated.contains(key(l))) known(key(l), 0);]=]
  [=[if (MUTANT || !stated.contains(key(l))) known(key(l), 0);]=])
mutant("worlds: a sub-plan is used for any worlds" worlds/belief_policy.cpp
  [=[  const Word* before = space_.sets(component).contents(world);
]=]
  [=[  const Word* before = space_.sets(component).contents(world);
  if (MUTANT) return true;
]=])
mutant("worlds: a sub-plan is used whatever later ones require" worlds/belief_policy.cpp
  [=[e.required.common[i] |= entries_[c.next].required.common[i] & ~operator_writes_[op][i];]=]
  [=[if (!MUTANT)
        e.required.common[i] |= entries_[c.next].required.common[i] & ~operator_writes_[op][i];]=])
