// External functions: bound to the host program or to tables in the text.
#include "language/external_binding.h"

#include <algorithm>
#include <map>
#include <optional>

#include "language/plural.h"

namespace kaboum::plan {
namespace {

/// Value by arguments; of a truth value 0 for true.
using Rows = std::map<std::vector<Index>, Index>;

void add_row(const syntax::Row& row, const Symbol& g, const SymbolTable& symbols, Rows& rows) {
  if (row.arguments.size() != g.parameters.size())
    row.location.fail("'" + g.name + "' takes " + plural(g.parameters.size(), "argument") +
                      ", not " + std::to_string(row.arguments.size()));
  std::vector<Index> key;
  for (std::size_t i = 0; i < row.arguments.size(); ++i)
    key.push_back(symbols.object(row.arguments[i], g.parameters[i]));
  if (row.value.text.empty() != (g.range == kNone))
    row.location.fail(g.range == kNone ? "'" + g.name + "' is a truth value: a row has no '='"
                                       : "expected '=' and the value of '" + g.name + "'");
  const Index value = g.range == kNone ? 0 : symbols.object(row.value, g.range);
  if (!rows.emplace(std::move(key), value).second)
    row.location.fail("a second row for the same arguments");
}

ExternalFunction table_function(Rows rows) {
  return [rows = std::move(rows)](std::span<const Index> arguments) -> std::optional<Index> {
    const auto row = rows.find({arguments.begin(), arguments.end()});
    if (row == rows.end()) return std::nullopt;
    return row->second;
  };
}

ExternalFunction host_function(
    const std::function<std::string(std::span<const std::string>)>& function, const Symbol& g,
    const SymbolTable& symbols) {
  const Model& model = symbols.model();
  std::vector<std::string> names;
  for (const Object& o : model.objects) names.push_back(o.name);
  std::vector<Index> values;
  if (g.range != kNone) values = model.types[g.range].objects;
  return [=, table = symbols.constants(), range = g.range,
          name = g.name](std::span<const Index> arguments) -> std::optional<Index> {
    std::vector<std::string> texts;
    for (const Index a : arguments) texts.push_back(names[a]);
    const std::string value = function(texts);
    if (value.empty()) return std::nullopt;
    if (range == kNone) return 0;
    const auto found = table.find(value);
    if (found == table.end() || !std::binary_search(values.begin(), values.end(), found->second))
      throw Error(ErrorCode::InvalidInput, "external function '" + name + "' returned '" + value +
                                               "', no constant of its type");
    return found->second;
  };
}

}  // namespace

std::vector<ExternalFunction> bind_externals(const syntax::Document& document,
                                             const ExternalBindings& bindings,
                                             const SymbolTable& symbols) {
  const Model& model = symbols.model();
  std::vector<std::optional<Rows>> tables(model.externals.size());
  for (const syntax::Table& t : document.tables) {
    const Index external = symbols.external(t.external);
    if (!tables[external]) tables[external].emplace();
    for (const syntax::Row& row : t.rows)
      add_row(row, model.externals[external], symbols, *tables[external]);
  }
  std::vector<ExternalFunction> functions;
  for (std::size_t i = 0; i < model.externals.size(); ++i) {
    const Symbol& g = model.externals[i];
    const auto host = bindings.find(g.name);
    if (host != bindings.end()) {
      if (g.parameters.empty())
        document.externals[i].name.location.fail(
            "external function '" + g.name +
            "' has no arguments and cannot see the state: it would be a constant, or tell what "
            "earlier calls left behind; write a constant, or return the value from the function "
            "that finds it");
      functions.push_back(host_function(host->second, g, symbols));
    } else if (tables[i]) {
      functions.push_back(table_function(std::move(*tables[i])));
    } else {
      document.externals[i].name.location.fail("external function '" + g.name +
                                               "' is bound to nothing: give a 'table " + g.name +
                                               ":' or bind it in the host program");
    }
  }
  return functions;
}

}  // namespace kaboum::plan
