#pragma once

#include <kaboum/plan/model.h>

#include <string>
#include <unordered_map>

#include "language/syntax.h"

namespace kaboum::plan {

/// Most arguments of a symbol.
inline constexpr std::size_t kMaximumArity = 12;
/// Most parameters of an action.
inline constexpr std::size_t kMaximumParameters = 64;

/// Index by name.
using NameTable = std::unordered_map<std::string, Index>;

/// What the names of a document are: types, constants, predicates, functions, external functions.
class SymbolTable {
 public:
  /// Declares everything in `model`, which must outlive the table.
  /// @throws Error{InvalidInput} at a name declared twice, an unknown type, or a cycle of types.
  SymbolTable(const syntax::Document& document, Model& model);

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const NameTable& constants() const { return objects_; }

  // By name. @throws Error{InvalidInput} if it is unknown, or a constant of another type.
  [[nodiscard]] Index type(const syntax::Name& name) const;             ///< empty text: any object
  [[nodiscard]] Index enumerated_type(const syntax::Name& name) const;  ///< no handle type
  [[nodiscard]] Index object(const syntax::Name& name, Index wanted_type) const;
  [[nodiscard]] Index predicate(const syntax::Name& name) const;
  [[nodiscard]] Index external(const syntax::Name& name) const;

  // nullptr: the term is something else. A constant hides a function of its name.
  [[nodiscard]] const Index* function_of(const syntax::Term& t) const;
  [[nodiscard]] const Index* predicate_of(const syntax::Term& t) const;
  [[nodiscard]] bool is_constant(const syntax::Name& name) const {
    return objects_.contains(name.text);
  }
  [[nodiscard]] bool is_predicate(const std::string& name) const {
    return predicates_.contains(name);
  }

  [[nodiscard]] bool is_handle(Index type) const {
    return type != kNone && model_.types[type].handle;
  }
  /// Whether `a` is `b` or a type below it, so that its objects are of both.
  [[nodiscard]] bool is_subtype(Index a, Index b) const;
  /// Whether one of them, or of what it is a union of, is a subtype of the other.
  [[nodiscard]] bool related(Index a, Index b) const;
  /// @throws Error{InvalidInput} if type `found` of what is named is no subtype of `wanted`.
  void check_type(const syntax::Name& name, Index found, Index wanted) const;

  /// @throws Error{InvalidInput} if `table` has the name already.
  static void unique(NameTable& table, const syntax::Name& name, Index index, const char* what);

 private:
  void declare_types(const syntax::Document& document);
  void declare_members(const syntax::Document& document);
  void declare_constants(const syntax::Document& document);
  void declare_symbols(const syntax::Document& document);
  [[nodiscard]] Symbol symbol(const syntax::Signature& s, bool external) const;
  [[nodiscard]] const std::string& type_name(Index t) const { return model_.types[t].name; }

  Model& model_;
  NameTable types_, objects_, predicates_, functions_, externals_;
};

}  // namespace kaboum::plan
