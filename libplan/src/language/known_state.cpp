// A task from another state: what is known there as initial knowledge.
#include "language/known_state.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <unordered_map>

namespace kaboum::plan {
namespace {

/// The names of a model, looked up.
class ModelNames {
 public:
  explicit ModelNames(const Model& model) {
    for (Index i = 0; i < model.predicates.size(); ++i) predicates_[model.predicates[i].name] = i;
    for (Index i = 0; i < model.functions.size(); ++i) functions_[model.functions[i].name] = i;
    for (Index i = 0; i < model.objects.size(); ++i) objects_[model.objects[i].name] = i;
  }

  [[nodiscard]] Update::Literal literal(const KnownFacts::Term& term, bool function,
                                        bool negated) const {
    Update::Literal out;
    out.function = function;
    out.negated = negated;
    out.symbol = find(function ? functions_ : predicates_, term.at(0));
    for (std::size_t i = 1; i < term.size(); ++i) out.arguments.push_back(object(term[i]));
    return out;
  }
  [[nodiscard]] Argument object(const std::string& name) const {
    return {false, find(objects_, name), {}};
  }

 private:
  using Table = std::unordered_map<std::string, Index>;
  static Index find(const Table& table, const std::string& name) {
    const auto found = table.find(name);
    if (found == table.end())
      throw Error(ErrorCode::InvalidInput, "the task has no '" + name + "', of which it is known");
    return found->second;
  }
  Table predicates_, functions_, objects_;
};

Update stated(Update::Literal literal) {
  Update out;
  out.literals.push_back(std::move(literal));
  return out;
}

}  // namespace

void declare_words(const KnownFacts& known, syntax::Document& document) {
  std::unordered_map<std::string, const syntax::Signature*> functions;
  for (const syntax::Signature& f : document.functions) functions[f.name.text] = &f;
  std::set<std::string> handles, constants;
  for (const syntax::Type& t : document.types)
    if (t.handle) handles.insert(t.name.text);
  for (const syntax::TypedVariable& c : document.constants) constants.insert(c.name.text);
  for (const auto& [term, value] : known.values) {
    const auto f = functions.find(term.at(0));
    if (f == functions.end() || !handles.contains(f->second->range.text)) continue;
    if (!constants.insert(value).second) continue;
    syntax::TypedVariable word;
    word.name = {value, f->second->name.location};
    word.type = f->second->range;
    document.constants.push_back(std::move(word));
  }
}

void start_from(const KnownFacts& facts, Model& model) {
  const ModelNames names(model);
  std::vector<Update> initial;
  for (const auto& [term, truth] : facts.atoms)
    initial.push_back(stated(names.literal(term, false, !truth)));
  for (const auto& [term, value] : facts.values) {
    Update::Literal l = names.literal(term, true, false);
    l.value = names.object(value);
    if (!model.is_a(l.value->index, model.functions[l.symbol].range))
      throw Error(ErrorCode::InvalidInput,
                  "it cannot be planned again where '" + term[0] + "' has the value '" + value +
                      "', which is a name of two types here: words of handles have to differ from "
                      "objects, and from words of other types of handles");
    initial.push_back(stated(std::move(l)));
  }
  for (const auto& [term, values] : facts.excluded) {
    if (facts.values.contains(term)) continue;
    for (const std::string& value : values) {
      Update::Literal l = names.literal(term, true, true);
      l.value = names.object(value);
      initial.push_back(stated(std::move(l)));
    }
  }
  for (const std::set<KnownFacts::Term>& entry : facts.exclusive) {
    Update u;
    u.database = Update::Database::Kx;
    for (const KnownFacts::Term& term : entry)
      u.literals.push_back(names.literal(term, false, false));
    initial.push_back(std::move(u));
  }
  for (const auto& entry : facts.some) {
    Update u;
    u.database = Update::Database::Or;
    for (const auto& [term, truth] : entry)
      u.literals.push_back(names.literal(term, false, !truth));
    initial.push_back(std::move(u));
  }
  model.initial = std::move(initial);
  model.cut = facts.cut;
}

}  // namespace kaboum::plan
