// Symbol tables: what each name of a document is in the model, and the hierarchy of types.
#include "language/symbol_table.h"

#include <algorithm>

namespace kaboum::plan {

namespace sx = syntax;
using sx::Name;

namespace {

constexpr std::size_t kMaximumTypes = 10'000;

bool is_union(const sx::Document& document, const Name& type) {
  return std::any_of(document.types.begin(), document.types.end(), [&](const sx::Type& t) {
    return !t.members.empty() && t.name.text == type.text;
  });
}

bool same_union(const sx::Type& a, const sx::Type& b) {
  return a.name.text == b.name.text && !a.members.empty() &&
         std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                    [](const Name& x, const Name& y) { return x.text == y.text; });
}

}  // namespace

SymbolTable::SymbolTable(const sx::Document& document, Model& model) : model_(model) {
  declare_types(document);
  declare_constants(document);
  declare_symbols(document);
}

void SymbolTable::unique(NameTable& table, const Name& name, Index index, const char* what) {
  if (!table.emplace(name.text, index).second)
    name.location.fail(std::string(what) + " '" + name.text + "' is declared twice");
}

/// The root of the types is "object", unless the text declares that as one type among others, as
/// the thesis does ("types: object, robot"): then the root has no name.
void SymbolTable::declare_types(const sx::Document& document) {
  const auto is_object = [](const sx::Type& t) { return t.name.text == "object"; };
  const bool object_is_a_type =
      std::any_of(document.types.begin(), document.types.end(), is_object) &&
      std::none_of(document.types.begin(), document.types.end(),
                   [](const sx::Type& t) { return t.parent.text == "object"; });
  model_.types.push_back({object_is_a_type ? "any type" : "object", kNone, {}, false});
  types_.emplace(model_.types[0].name, 0);
  for (const sx::Type& t : document.types) {
    if (t.name.text == "number" || (t.name.text == "object" && !object_is_a_type)) {
      if (!t.parent.text.empty())
        t.name.location.fail("type '" + t.name.text + "' cannot have a parent");
      continue;
    }
    if (model_.types.size() >= kMaximumTypes) t.name.location.fail("too many types");
    if (std::any_of(document.types.data(), &t, [&](const sx::Type& o) { return same_union(o, t); }))
      continue;  // a domain and its problem may both name it
    unique(types_, t.name, static_cast<Index>(model_.types.size()), "type");
    // Handles are no objects: they are below no other type.
    model_.types.push_back({t.name.text, t.handle ? kNone : 0, {}, t.handle});
  }
  for (const sx::Type& t : document.types)
    if (!t.parent.text.empty()) {
      if (model_.types[type(t.parent)].handle)
        t.name.location.fail("'" + t.parent.text + "' is a handle type: it has no subtypes");
      if (is_union(document, t.parent))
        t.name.location.fail("'" + t.parent.text + "' is a union of types: it has no subtypes");
      model_.types[types_.at(t.name.text)].parent = type(t.parent);
    }
  declare_members(document);
  for (const sx::Type& t : document.types) {
    const auto found = types_.find(t.name.text);
    Index up = found == types_.end() ? kNone : found->second;
    for (std::size_t steps = 0; up != kNone; up = model_.types[up].parent)
      if (++steps > model_.types.size())
        t.name.location.fail("type '" + t.name.text + "' is its own ancestor");
  }
}

void SymbolTable::declare_members(const sx::Document& document) {
  for (const sx::Type& u : document.types) {
    if (u.members.empty()) continue;
    std::vector<Index> members;
    for (const Name& m : u.members) {
      if (is_union(document, m)) m.location.fail("'" + m.text + "' is a union of types itself");
      members.push_back(enumerated_type(m));
    }
    model_.types[type(u.name)].members = std::move(members);
  }
}

Index SymbolTable::type(const Name& name) const {
  if (name.text.empty()) return 0;
  const auto found = types_.find(name.text);
  if (found == types_.end()) name.location.fail("unknown type '" + name.text + "'");
  return found->second;
}

void SymbolTable::declare_constants(const sx::Document& document) {
  for (const sx::TypedVariable& c : document.constants) {
    const auto index = static_cast<Index>(model_.objects.size());
    unique(objects_, c.name, index, "constant");
    const Index t = type(c.type);
    if (!model_.types[t].members.empty())
      c.name.location.fail("'" + c.name.text +
                           "' would be of a union of types: a constant is of one");
    model_.objects.push_back({c.name.text, t});
    for (Index up = t; up != kNone; up = model_.types[up].parent)
      model_.types[up].objects.push_back(index);
    for (Type& u : model_.types)
      if (std::any_of(u.members.begin(), u.members.end(),
                      [&](Index member) { return is_subtype(t, member); }))
        u.objects.push_back(index);
  }
}

Index SymbolTable::enumerated_type(const Name& name) const {
  const Index t = type(name);
  if (model_.types[t].handle)
    name.location.fail("'" + name.text +
                       "' is a handle type, whose values are not enumerated: it can be the type of "
                       "a function's value and of what external functions take and return");
  return t;
}

Symbol SymbolTable::symbol(const sx::Signature& s, bool external) const {
  if (s.parameters.size() > kMaximumArity) s.name.location.fail("more than 12 arguments");
  Symbol result;
  result.name = s.name.text;
  for (const Name& p : s.parameters)
    result.parameters.push_back(external ? type(p) : enumerated_type(p));
  return result;
}

void SymbolTable::declare_symbols(const sx::Document& document) {
  for (const sx::Signature& s : document.predicates) {
    unique(predicates_, s.name, static_cast<Index>(model_.predicates.size()), "predicate");
    model_.predicates.push_back(symbol(s, false));
  }
  for (const sx::Rule& r : document.rules) model_.predicates[predicate(r.head)].level = 0;
  for (const sx::Signature& s : document.functions) {
    unique(functions_, s.name, static_cast<Index>(model_.functions.size()), "function");
    if (predicates_.contains(s.name.text))
      s.name.location.fail("'" + s.name.text + "' is a predicate already");
    Symbol f = symbol(s, false);
    f.numeric = s.range.text == "number";
    f.range = f.numeric ? kNone : type(s.range);
    model_.functions.push_back(f);
  }
  for (const sx::Signature& s : document.externals) {
    unique(externals_, s.name, static_cast<Index>(model_.externals.size()), "external function");
    Symbol g = symbol(s, true);
    if (!s.range.text.empty()) g.range = type(s.range);
    model_.externals.push_back(g);
  }
  model_.numbers.resize(model_.functions.size());
}

Index SymbolTable::object(const Name& name, Index wanted_type) const {
  const auto found = objects_.find(name.text);
  if (found == objects_.end()) name.location.fail("unknown constant '" + name.text + "'");
  if (!model_.is_a(found->second, wanted_type))
    name.location.fail("'" + name.text + "' is of type " +
                       type_name(model_.objects[found->second].type) + ", expected " +
                       type_name(wanted_type));
  return found->second;
}

Index SymbolTable::external(const Name& name) const {
  const auto found = externals_.find(name.text);
  if (found == externals_.end())
    name.location.fail("unknown external function '" + name.text + "'");
  return found->second;
}

Index SymbolTable::predicate(const Name& name) const {
  const auto found = predicates_.find(name.text);
  if (found == predicates_.end()) name.location.fail("unknown predicate '" + name.text + "'");
  return found->second;
}

bool SymbolTable::is_subtype(Index a, Index b) const {
  if (a == kNone || b == kNone) return false;
  const auto& of_a = model_.types[a].members;
  const auto& of_b = model_.types[b].members;
  if (std::any_of(of_b.begin(), of_b.end(), [&](Index m) { return is_subtype(a, m); }) ||
      (!of_a.empty() &&
       std::all_of(of_a.begin(), of_a.end(), [&](Index m) { return is_subtype(m, b); })))
    return true;
  for (Index up = a; up != kNone; up = model_.types[up].parent)
    if (up == b) return true;
  return false;
}

const Index* SymbolTable::function_of(const sx::Term& t) const {
  if (t.kind != sx::Term::Kind::Call && t.kind != sx::Term::Kind::Name) return nullptr;
  if (t.kind == sx::Term::Kind::Name && objects_.contains(t.name.text)) return nullptr;
  const auto found = functions_.find(t.name.text);
  return found == functions_.end() ? nullptr : &found->second;
}

const Index* SymbolTable::predicate_of(const sx::Term& t) const {
  if (t.kind != sx::Term::Kind::Call && t.kind != sx::Term::Kind::Name) return nullptr;
  const auto found = predicates_.find(t.name.text);
  return found == predicates_.end() ? nullptr : &found->second;
}

void SymbolTable::check_type(const Name& name, Index found, Index wanted) const {
  if (is_subtype(found, wanted)) return;
  name.location.fail("'" + name.text + "' is of type " + type_name(found) + ", expected " +
                     type_name(wanted));
}

bool SymbolTable::related(Index a, Index b) const {
  if (is_subtype(a, b) || is_subtype(b, a)) return true;
  if (a == kNone || b == kNone) return false;
  const auto& of_a = model_.types[a].members;
  const auto& of_b = model_.types[b].members;
  return std::any_of(of_a.begin(), of_a.end(), [&](Index m) { return related(m, b); }) ||
         std::any_of(of_b.begin(), of_b.end(), [&](Index m) { return related(a, m); });
}

}  // namespace kaboum::plan
