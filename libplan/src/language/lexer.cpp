// Tokens of .kpl; signs of logic in UTF-8 are spelt as their ASCII forms.
#include "language/lexer.h"

#include <array>

namespace kaboum::plan {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// What may stand for an operator, longest first; each with the spelling the parser sees.
constexpr std::array<std::pair<std::string_view, std::string_view>, 27> kSymbols = {{
    {"<=>", "<=>"}, {"⟹", "=>"}, {"⇒", "=>"},    {"∧", "&"},   {"∨", "|"}, {"¬", "!"},
    {"⊕", "xor"},   {"≠", "!="}, {"=>", "=>"},   {"!=", "!="}, {"(", "("}, {")", ")"},
    {"[", "["},     {"]", "]"},  {",", ","},     {";", ";"},   {":", ":"}, {"=", "="},
    {"!", "!"},     {"&", "&"},  {"^", "&"},     {"|", "|"},   {"/", "/"}, {"{", "{"},
    {"}", "}"},     {"+", "+"},  {"...", "..."},
}};

}  // namespace

std::vector<Token> tokenize(const Source& source) {
  const std::string& text = source.text;
  std::vector<Token> tokens;
  std::size_t i = 0;
  const auto starts = [&](std::string_view s) { return text.compare(i, s.size(), s) == 0; };
  const auto name_end = [&](std::size_t at) {
    while (at < text.size() && (is_letter(text[at]) || is_digit(text[at]) || text[at] == '\'' ||
                                (text[at] == '-' && at + 1 < text.size() && text[at + 1] != '-')))
      ++at;
    return at;
  };
  if (starts("\xef\xbb\xbf")) i = 3;  // byte order mark
  while (i < text.size()) {
    const char c = text[i];
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      ++i;
    } else if (c == '#' || starts("--") || starts("//")) {
      while (i < text.size() && text[i] != '\n') ++i;
    } else if (is_letter(c)) {
      const std::size_t end = name_end(i);
      tokens.push_back({Token::Kind::Name, text.substr(i, end - i), i});
      i = end;
    } else if (c == '?') {
      const std::size_t end = name_end(i + 1);
      if (end == i + 1) source.fail(i, "a variable's name must follow '?'");
      tokens.push_back({Token::Kind::Variable, text.substr(i + 1, end - i - 1), i});
      i = end;
    } else if (is_digit(c)) {
      std::size_t end = i;
      while (end < text.size() && is_digit(text[end])) ++end;
      tokens.push_back({Token::Kind::Number, text.substr(i, end - i), i});
      i = end;
    } else {
      bool found = false;
      for (const auto& [spelling, meaning] : kSymbols) {
        if (!starts(spelling)) continue;
        tokens.push_back({Token::Kind::Symbol, std::string(meaning), i});
        i += spelling.size();
        found = true;
        break;
      }
      if (!found) source.fail(i, "unexpected character");
    }
  }
  tokens.push_back({Token::Kind::End, "", text.size()});
  return tokens;
}

}  // namespace kaboum::plan
