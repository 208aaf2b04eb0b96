// From the syntax tree to the model: every name is looked up, every type checked.
#include "language/resolve.h"

#include "language/effect_resolver.h"
#include "language/external_binding.h"
#include "language/initial_state.h"
#include "language/numbers.h"
#include "language/query_resolver.h"
#include "language/rule_resolver.h"
#include "language/symbol_table.h"
#include "language/term_resolver.h"

namespace kaboum::plan {
namespace {

namespace sx = syntax;

class Resolver {
 public:
  Resolver(const sx::Document& document, const ExternalBindings& bindings)
      : document_(document), bindings_(bindings) {}

  Model run() {
    model_.name = document_.name.text;
    model_.external_functions = bind_externals(document_, bindings_, symbols_);
    resolve_rules(document_, queries_, model_);
    for (const sx::Action& a : document_.actions) declare_action(a);
    declare_goal();
    InitialState(terms_, effects_, model_).declare(document_);
    require_values(document_, model_);
    return std::move(model_);
  }

 private:
  void declare_action(const sx::Action& a) {
    SymbolTable::unique(actions_, a.name, static_cast<Index>(model_.actions.size()), "action");
    if (a.parameters.size() > kMaximumParameters) a.name.location.fail("more than 64 parameters");
    Action action;
    action.name = a.name.text;
    Scope scope;
    scope.location = a.name.location;
    for (const sx::TypedVariable& p : a.parameters) {
      if (scope.find(p.name.text) != nullptr)
        p.name.location.fail("parameter '?" + p.name.text + "' is declared twice");
      const Index t = symbols_.enumerated_type(p.type);
      scope.variables.push_back({p.name.text, scope.fresh(), t});
      action.parameters.push_back({p.name.text, t});
    }
    action.precondition = queries_.precondition(a.precondition, scope);
    for (const sx::Effect& e : a.effects) action.effects.push_back(effects_.effect(e, scope));
    if (!a.cost.empty()) resolve_cost(a.cost.at(0), terms_, scope, action);
    action.slots = scope.slots;
    model_.actions.push_back(std::move(action));
  }

  void declare_goal() {
    Scope scope;
    model_.goal.kind = Query::Kind::And;
    for (const sx::Formula& g : document_.goals) {
      scope.location = g.location;
      Query q = queries_.query(g, scope);
      if (q.kind == Query::Kind::And) {
        for (Query& child : q.children) model_.goal.children.push_back(std::move(child));
      } else {
        model_.goal.children.push_back(std::move(q));
      }
    }
    model_.goal_slots = scope.slots;
    if (document_.goals.empty())
      throw Error(
          ErrorCode::InvalidInput,
          (document_.sources.empty() ? "" : document_.sources.back()->name + ": ") +
              std::string("no goal: give the problem's file after the domain's, or a 'goal:' "
                          "section"));
  }

  const sx::Document& document_;
  const ExternalBindings& bindings_;
  Model model_;
  NameTable actions_;
  SymbolTable symbols_{document_, model_};
  TermResolver terms_{symbols_};
  QueryResolver queries_{terms_};
  EffectResolver effects_{terms_, queries_};
};

}  // namespace

Model resolve(const syntax::Document& document, const ExternalBindings& bindings) {
  return Resolver(document, bindings).run();
}

}  // namespace kaboum::plan
