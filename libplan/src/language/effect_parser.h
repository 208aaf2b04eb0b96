#pragma once

#include <optional>
#include <vector>

#include "language/formula_parser.h"

namespace kaboum::plan {

/// Reads effects and initial entries of .kpl. All functions throw Error{InvalidInput}.
class EffectParser {
 public:
  EffectParser(TokenStream& in, FormulaParser& formulas) : in_(in), formulas_(formulas) {}

  /// Up to the next section or closing parenthesis.
  std::vector<syntax::Effect> effects();
  /// add(Kf, ...) or the short forms K(...), Kw(...), Kv(...), Kx(a | b), LCW(...), or a bare
  /// literal, up to the next section.
  std::vector<syntax::Effect> initial();

 private:
  syntax::Effect effect();
  std::vector<syntax::Effect> body();
  std::optional<syntax::Database> database();
  syntax::Effect update();
  std::vector<syntax::Formula> contents(syntax::Database database);

  TokenStream& in_;
  FormulaParser& formulas_;
};

}  // namespace kaboum::plan
