// Reading tokens with look-ahead, and what is expected next.
#include "language/token_stream.h"

#include <algorithm>
#include <array>

namespace kaboum::plan {

TokenStream::Level::Level(TokenStream& in) : in_(in) {
  if (++in_.depth_ > kMaximumNesting) in_.location().fail("nested too deeply");
}

const Token& TokenStream::peek(std::size_t ahead) const {
  return tokens_[std::min(next_ + ahead, tokens_.size() - 1)];
}

bool TokenStream::accept(std::string_view symbol) {
  if (!is(symbol)) return false;
  skip();
  return true;
}

bool TokenStream::heading(std::string_view keyword) {
  if (!is(keyword) || !is(":", 1)) return false;
  skip(2);
  return true;
}

std::string TokenStream::found() const {
  return at_end() ? "the end of the file" : "'" + peek().text + "'";
}

void TokenStream::expect(std::string_view symbol, std::string_view where) {
  if (!accept(symbol))
    location().fail("expected '" + std::string(symbol) + "' " + std::string(where) + ", found " +
                    found());
}

syntax::Name TokenStream::name(std::string_view what) {
  if (peek().kind != Token::Kind::Name)
    location().fail("expected " + std::string(what) + ", found " + found());
  syntax::Name result{peek().text, location()};
  skip();
  return result;
}

void TokenStream::skip_separators() {
  while (accept(",") || accept(";") || accept("&")) {
  }
}

bool TokenStream::at_section() const {
  static constexpr std::array kWithColon = {
      "types",  "constants", "objects", "predicates", "functions", "externals", "init",
      "closed", "unknown",   "goal",    "preconds",   "effects",   "cost"};
  static constexpr std::array kOthers = {"action", "table", "domain", "problem", "symbols"};
  if (at_end()) return true;
  if (peek().kind != Token::Kind::Name) return false;
  for (const char* keyword : kWithColon)
    if (is(keyword) && is(":", 1)) return true;
  if (is("symbols")) return true;
  for (const char* keyword : kOthers)
    if (is(keyword) && peek(1).kind == Token::Kind::Name)
      // An object may be called table: a table has rows.
      return !is("table") || (is(":", 2) && is("(", 3));
  return false;
}

/// "=>" or an update inside it says so.
bool TokenStream::parenthesis_holds_effect() const {
  int depth = 0;
  for (std::size_t i = next_; i < tokens_.size(); ++i) {
    if (tokens_[i].is("(")) ++depth;
    if (tokens_[i].is(")") && --depth == 0) return false;
    if (tokens_[i].is("=>")) return true;
    if ((tokens_[i].is("add") || tokens_[i].is("del") || tokens_[i].is("maybe")) &&
        i + 1 < tokens_.size() && tokens_[i + 1].is("("))
      return true;
  }
  return false;
}

}  // namespace kaboum::plan
