// The initial state. Its entries are all about the same world: each is learnt, none is a change of
// it.
#include "task/initial_knowledge.h"

#include <kaboum/base/error.h>

#include <set>

#include "task/ground_text.h"
#include "task/knowledge.h"

namespace kaboum::plan {
namespace {

std::vector<Index> objects_of(const Update::Literal& l) {
  std::vector<Index> objects;
  for (const Argument& a : l.arguments) objects.push_back(a.index);
  return objects;
}

class Learner {
 public:
  Learner(const Model& model, const Layout& layout)
      : model_(model), layout_(layout), knowledge_(layout) {}

  std::vector<Word> run() {
    for (const Update& u : model_.initial) {
      const Update::Literal& l = u.literals[0];
      const std::vector<Index> arguments = objects_of(l);
      const Layout::Field p = l.function ? layout_.term(l.symbol, arguments.data())
                                         : layout_.atom(l.symbol, arguments.data());
      if (learn(u, p)) continue;
      const std::string& name = (l.function ? model_.functions : model_.predicates)[l.symbol].name;
      throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself about '" +
                                               ground_text(model_, name, arguments) + "'");
    }
    return {knowledge_.words(), knowledge_.words() + layout_.words()};
  }

 private:
  /// @return false if the entry contradicts what was learnt before.
  bool learn(const Update& u, const Layout::Field& p) {
    switch (u.database) {
      case Update::Database::Kf:
        return learn_fact(u.literals[0], p);
      case Update::Database::Kw:
        return knowledge_.apply({Change::Kind::AddWhether, p.fluent, 0, {}});
      case Update::Database::Kv:
        knowledge_.apply({Change::Kind::AddSensed, p.fluent, 0, {}});
        return true;
      case Update::Database::Kx:
        return u.literals[0].function ? learn_options(u, p) : learn_group(u);
      case Update::Database::Lcw:
        // What Kw or Kx speaks of is stated, if not decided.
        return p.fluent == kNone || knowledge_.atom(p.fluent) != AtomKnowledge::Unknown ||
               stated_.contains(p.fluent) || knowledge_.learn_atom(p.fluent, false);
      case Update::Database::Or:
        break;  // not in a model's knowledge view
    }
    return true;
  }

  bool learn_fact(const Update::Literal& l, const Layout::Field& p) {
    if (p.fluent == kNone)
      return l.function ? p.value == l.value->index
                        : p.atom == (l.negated ? AtomKnowledge::False : AtomKnowledge::True);
    if (!l.function) return knowledge_.learn_atom(p.fluent, !l.negated);
    return l.negated ? knowledge_.learn_not_value(p.fluent, position(l))
                     : knowledge_.learn_value(p.fluent, position(l));
  }

  bool learn_options(const Update& u, const Layout::Field& p) {
    std::vector<Index> options;
    for (const Update::Literal& l : u.literals) options.push_back(position(l));
    return knowledge_.learn_options(p.fluent, options);
  }

  bool learn_group(const Update& u) {
    std::vector<Index> members;
    for (const Update::Literal& l : u.literals)
      members.push_back(layout_.atom(l.symbol, objects_of(l).data()).fluent);
    stated_.insert(members.begin(), members.end());
    return knowledge_.learn_group(layout_.group(std::move(members)));
  }

  [[nodiscard]] Index position(const Update::Literal& l) const {
    return layout_.position(model_.functions[l.symbol].range, l.value->index);
  }

  const Model& model_;
  const Layout& layout_;
  Knowledge knowledge_;
  std::set<Index> stated_;  ///< fluents of entries of Kx
};

}  // namespace

std::vector<Word> initial_knowledge(const Model& model, const Layout& layout) {
  return Learner(model, layout).run();
}

}  // namespace kaboum::plan
