// A domain and its problem as one document.
#include "language/syntax.h"

#include <iterator>

namespace kaboum::plan {
namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

syntax::Document syntax::merge(Document domain, Document problem) {
  if (domain.assumes_complete && !problem.unknown.empty())
    problem.unknown[0].location.fail(
        "incomplete knowledge needs the requirement ':contingent' in the domain");
  if (domain.name.text.empty()) domain.name = problem.name;
  append(domain.types, problem.types);
  append(domain.constants, problem.constants);
  append(domain.predicates, problem.predicates);
  append(domain.functions, problem.functions);
  append(domain.externals, problem.externals);
  append(domain.tables, problem.tables);
  append(domain.actions, problem.actions);
  append(domain.rules, problem.rules);
  append(domain.initial, problem.initial);
  append(domain.goals, problem.goals);
  append(domain.closed, problem.closed);
  domain.closed_world |= problem.closed_world;
  append(domain.unknown, problem.unknown);
  append(domain.sources, problem.sources);
  return domain;
}

}  // namespace kaboum::plan
