#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "language/lexer.h"
#include "language/syntax.h"

namespace kaboum::plan {

/// The tokens of a .kpl text, read one after another.
class TokenStream {
 public:
  /// @pre `source` outlives the stream. @throws Error{InvalidInput} as `tokenize`.
  explicit TokenStream(const Source& source) : source_(&source), tokens_(tokenize(source)) {}

  [[nodiscard]] const Token& peek(std::size_t ahead = 0) const;
  [[nodiscard]] bool at_end() const { return peek().kind == Token::Kind::End; }
  [[nodiscard]] bool is(std::string_view symbol, std::size_t ahead = 0) const {
    return peek(ahead).is(symbol);
  }
  void skip(std::size_t tokens = 1) { next_ += tokens; }
  bool accept(std::string_view symbol);    ///< skips it if it is next
  bool heading(std::string_view keyword);  ///< skips "keyword:" if that is next
  void skip_separators();                  ///< any of , ; &

  // What must be next. @throws Error{InvalidInput} if it is not.
  void expect(std::string_view symbol, std::string_view where);
  syntax::Name name(std::string_view what);

  // For messages.
  [[nodiscard]] SourceLocation location() const { return {source_, peek().offset}; }
  [[nodiscard]] std::string found() const;

  /// Whether a section of the document, or the end, is next.
  [[nodiscard]] bool at_section() const;
  /// Whether the parenthesis at hand groups effects, not a formula.
  [[nodiscard]] bool parenthesis_holds_effect() const;

  /// A level of nesting, as long as it lives. @throws Error{InvalidInput} if they are too many.
  class Level {
   public:
    explicit Level(TokenStream& in);
    ~Level() { --in_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    TokenStream& in_;
  };

 private:
  const Source* source_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  int depth_ = 0;
};

}  // namespace kaboum::plan
