// External functions: bound to the host program or to tables in the text.
#include "language/external_binding.h"

#include <algorithm>
#include <map>
#include <memory>
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
  return {[rows = std::move(rows)](std::span<const Index> arguments, ExternalContext&) {
            ExternalResult result;
            const auto row = rows.find({arguments.begin(), arguments.end()});
            if (row == rows.end()) return result;
            result.kind = Answer::Kind::Value;
            result.value = row->second;
            return result;
          },
          false};
}

/// The names of a model, for host functions: they outlive the tables of the reader.
struct Names {
  explicit Names(const SymbolTable& symbols)
      : types(symbols.model().types),
        objects(symbols.model().objects),
        object_of(symbols.constants()) {
    for (const auto* list : {&symbols.model().functions, &symbols.model().predicates})
      for (Index i = 0; i < list->size(); ++i) {
        const bool function = list == &symbols.model().functions;
        (function ? functions : predicates).emplace((*list)[i].name, std::pair((*list)[i], i));
      }
  }

  using Symbols = std::map<std::string, std::pair<Symbol, Index>, std::less<>>;

  std::vector<Type> types;
  std::vector<Object> objects;
  NameTable object_of;
  Symbols functions, predicates;

  [[nodiscard]] bool is_a(Index object, Index type) const {
    return std::binary_search(types[type].objects.begin(), types[type].objects.end(), object);
  }
  [[nodiscard]] std::string name(Index object, const HandleTable& handles) const {
    return object < objects.size() ? objects[object].name : std::string(handles.word(object));
  }
};

/// Looks up the names that a host function reads by.
class NamedState final : public StateView {
 public:
  NamedState(const Names& names, ExternalContext& context) : names_(names), context_(context) {}

  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) override {
    const auto& [symbol, index] = find(names_.functions, function, "function");
    if (symbol.numeric) throw Error(ErrorCode::InvalidInput, "'" + function + "' is a number");
    const auto found = context_.state.value(index, objects(symbol, arguments));
    if (!found) return std::nullopt;
    return names_.name(*found, context_.handles);
  }
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& arguments) override {
    const auto& [symbol, index] = find(names_.predicates, predicate, "predicate");
    return context_.state.truth(index, objects(symbol, arguments));
  }

  bool has_term(const std::string& function, const std::vector<std::string>& arguments) override {
    const auto symbol = names_.functions.find(function);
    if (symbol == names_.functions.end() || symbol->second.first.numeric) return false;
    const std::vector<Index>& types = symbol->second.first.parameters;
    if (types.size() != arguments.size()) return false;
    for (std::size_t i = 0; i < types.size(); ++i) {
      const auto object = names_.object_of.find(arguments[i]);
      if (object == names_.object_of.end() || !names_.is_a(object->second, types[i])) return false;
    }
    return true;
  }

 private:
  static const std::pair<Symbol, Index>& find(const Names::Symbols& symbols,
                                              const std::string& name, const char* what) {
    const auto found = symbols.find(name);
    if (found == symbols.end())
      throw Error(ErrorCode::InvalidInput,
                  "it reads '" + name + "', but the model has no " + what + " of that name");
    return found->second;
  }
  [[nodiscard]] std::vector<Index> objects(const Symbol& symbol,
                                           const std::vector<std::string>& arguments) const {
    if (arguments.size() != symbol.parameters.size())
      throw Error(ErrorCode::InvalidInput, "it reads '" + symbol.name + "' of " +
                                               plural(arguments.size(), "argument") + ", not " +
                                               std::to_string(symbol.parameters.size()));
    std::vector<Index> result;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const auto object = names_.object_of.find(arguments[i]);
      if (object == names_.object_of.end() || !names_.is_a(object->second, symbol.parameters[i]))
        throw Error(ErrorCode::InvalidInput, "it reads '" + symbol.name + "' of '" + arguments[i] +
                                                 "', which is no constant of type " +
                                                 names_.types[symbol.parameters[i]].name);
      result.push_back(object->second);
    }
    return result;
  }

  const Names& names_;
  ExternalContext& context_;
};

/// A seed for each function, arguments and attempt, whatever the order of calls.
std::uint64_t seed_of(const std::string& name, const std::vector<std::string>& arguments,
                      const ExternalContext& context) {
  std::uint64_t h = 0xcbf29ce484222325ULL ^ context.seed;
  const auto add = [&h](std::string_view text) {
    for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    h = (h ^ 0xffU) * 0x100000001b3ULL;
  };
  add(name);
  for (const std::string& a : arguments) add(a);
  h += (context.attempt + 1 + (std::uint64_t{context.choice} << 32U)) * 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27U)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 31U);
}

ExternalFunction host_function(const ExternalBinding& function, const Symbol& g,
                               std::shared_ptr<const Names> names) {
  return {[function, g, names = std::move(names)](std::span<const Index> arguments,
                                                  ExternalContext& context) {
            std::vector<std::string> texts;
            for (const Index a : arguments) texts.push_back(names->name(a, context.handles));
            NamedState state(*names, context);
            Answer answer = function({texts, state, seed_of(g.name, texts, context),
                                      context.attempt, context.choice, context.early});
            ExternalResult result;
            result.kind = answer.kind;
            result.payload = std::move(answer.payload);
            result.reason = std::move(answer.reason);
            result.chosen = answer.chosen;
            // What is impossible is so whatever is chosen.
            result.choices = answer.kind == Answer::Kind::Impossible ? 0 : answer.choices;
            result.fixed = answer.fixed;
            result.listed = answer.listed;
            if (answer.kind != Answer::Kind::Value || g.range == kNone) return result;
            const auto found = names->object_of.find(answer.value);
            const bool constant =
                found != names->object_of.end() && names->is_a(found->second, g.range);
            if (!constant && (!names->types[g.range].handle || answer.value.empty()))
              throw Error(ErrorCode::InvalidInput, "it returned '" + answer.value +
                                                       "', no constant of its type (" +
                                                       names->types[g.range].name + ")");
            result.value = constant ? found->second : context.handles.intern(g.range, answer.value);
            return result;
          },
          function.reads_state(), function.takes_seed(), function.refuses_early()};
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
  const auto names = std::make_shared<const Names>(symbols);
  std::vector<ExternalFunction> functions;
  for (std::size_t i = 0; i < model.externals.size(); ++i) {
    const Symbol& g = model.externals[i];
    const auto host = bindings.find(g.name);
    if (host != bindings.end()) {
      if (g.parameters.empty() && !host->second.reads_state())
        document.externals[i].name.location.fail(
            "external function '" + g.name +
            "' has no arguments and cannot see the state: it would be a constant, or tell what "
            "earlier calls left behind; write a constant, or return the value from the function "
            "that finds it");
      functions.push_back(host_function(host->second, g, names));
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
