// The text of STEP files: sections, entities, records, parameters.

#include "step_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace kaboum::io {
namespace {

constexpr double kLargest = 1e100;  ///< of numbers; OpenCASCADE takes larger ones for infinite

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return is_capital(c) || is_digit(c) || c == '_'; }

class Parser {
 public:
  Parser(std::string_view text, std::vector<StepToken>& tokens, std::vector<StepEntity>& entities)
      : text_(text), tokens_(tokens), entities_(entities) {}

  void run() {
    if (!text_.empty() && text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
    expect_word("ISO-10303-21");
    expect(';');
    expect_word("HEADER");
    expect(';');
    skip_section();
    bool data = false;
    for (;;) {
      const std::string_view word = next_word();
      if (word == "END-ISO-10303-21") break;
      if (word == "DATA") {
        if (peek() == '(') skip_parameters();
        expect(';');
        read_entities();
        data = true;
      } else if (word == "SIGNATURE") {
        break;  // what follows is encoded otherwise, and signs what was read
      } else if (word == "ANCHOR") {
        expect(';');
        skip_section();
      } else {
        fail(word == "REFERENCE" ? "a section that refers to other files"
                                 : "a section '" + std::string(word) + "'");
      }
    }
    if (!data) fail("no DATA section");
    if (text_.find("ISO-10303-21;", at_) != std::string_view::npos &&
        text_.find("DATA;", at_) != std::string_view::npos)
      fail("a second file after the end of the first");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
    throw std::runtime_error("line " + std::to_string(1 + std::count(text_.begin(), end, '\n')) +
                             ": " + what);
  }

  void skip_space() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\f' || c == '\v') {
        ++at_;
      } else if (c == '\\' && at_ + 2 < text_.size() &&
                 (text_[at_ + 1] == 'N' || text_[at_ + 1] == 'F') && text_[at_ + 2] == '\\') {
        at_ += 3;  // print control directive
      } else if (c == '/' && at_ + 1 < text_.size() && text_[at_ + 1] == '*') {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) fail("a comment without an end");
        at_ = end + 2;
      } else {
        return;
      }
    }
  }
  char peek() {
    skip_space();
    if (at_ >= text_.size()) fail("the file is cut");
    return text_[at_];
  }
  void expect(char c) {
    if (peek() != c) fail(std::string("'") + c + "' expected");
    ++at_;
  }
  /// Words of sections have hyphens.
  std::string_view next_word() {
    peek();
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_word(text_[at_]) || text_[at_] == '-')) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void expect_word(std::string_view word) {
    if (next_word() != word) fail("'" + std::string(word) + "' expected");
  }
  void skip_section() {
    for (;;) {
      const std::size_t before = at_;
      if (next_word() == "ENDSEC") {
        expect(';');
        return;
      }
      at_ = before;
      skip_statement();
    }
  }
  void skip_statement() {
    for (char c = peek(); c != ';'; c = peek()) {
      if (c == '\'' || c == '"') {
        skip_quoted(c);
      } else {
        ++at_;
      }
    }
    ++at_;
  }
  void skip_quoted(char quote) {
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a text without an end");
    at_ = end + 1;  // a doubled quote begins another text
  }
  void skip_parameters() {
    std::vector<StepToken> none;
    none.swap(tokens_);
    parameters();
    none.swap(tokens_);
  }

  std::int64_t number() {
    std::int64_t n = 0;
    const std::size_t begin = at_;
    for (; at_ < text_.size() && is_digit(text_[at_]); ++at_) {
      if (n > (INT64_MAX - 9) / 10) fail("a number of an entity that is too large");
      n = 10 * n + (text_[at_] - '0');
    }
    if (at_ == begin) fail("a number of an entity expected");
    return n;
  }

  void read_entities() {
    for (;;) {
      if (peek() != '#') {
        expect_word("ENDSEC");
        expect(';');
        return;
      }
      ++at_;
      StepEntity entity;
      entity.id = number();
      expect('=');
      if (peek() == '&') fail("a scope, which is not read");
      if (peek() == '(') {
        ++at_;
        while (peek() != ')') entity.records.push_back(record());
        ++at_;
      } else {
        entity.records.push_back(record());
      }
      expect(';');
      if (entity.records.empty()) fail("an entity without a type");
      entities_.push_back(std::move(entity));
    }
  }

  StepRecord record() {
    StepRecord out;
    const char first = peek();
    const std::size_t begin = at_;
    if (first == '!') ++at_;
    while (at_ < text_.size() && is_word(text_[at_])) ++at_;
    out.name = text_.substr(begin, at_ - begin);
    if (out.name.empty()) fail("the type of an entity expected, in capital letters");
    if (peek() != '(') fail("'(' expected after " + std::string(out.name));
    out.begin = tokens_.size() + 1;
    parameters();
    out.end = tokens_.size() - 1;
    return out;
  }

  /// From an opening bracket to the one that closes it.
  void parameters() {
    std::size_t depth = 0;
    do {
      const char c = peek();
      if (c == '(') {
        ++depth;
        tokens_.push_back({StepToken::Open});
        ++at_;
      } else if (c == ')') {
        --depth;
        tokens_.push_back({StepToken::Close});
        ++at_;
      } else if (c == ',') {
        ++at_;
      } else if (c == '#') {
        ++at_;
        tokens_.push_back({StepToken::Reference, number()});
      } else if (c == '$' || c == '*') {
        tokens_.push_back({c == '$' ? StepToken::Omitted : StepToken::Derived});
        ++at_;
      } else if (c == '\'' || c == '"') {
        skip_quoted(c);
        while (at_ < text_.size() && text_[at_] == c) skip_quoted(c);
        tokens_.push_back({StepToken::Value});
      } else if (c == ';' || c == '=') {
        fail("a parameter expected");
      } else {
        word();
      }
    } while (depth > 0);
  }

  /// A number, an enumeration, or a type before its value's brackets.
  void word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           std::string_view(" \n\r\t\f\v(),;'\"#/$*=").find(text_[at_]) == std::string_view::npos)
      ++at_;
    if (at_ == begin) fail("a parameter expected");
    const bool typed = is_capital(text_[begin]);
    if (typed && peek() == '(') return;  // its value follows, as a list of one
    check_value(text_.substr(begin, at_ - begin));
    tokens_.push_back({StepToken::Value, static_cast<std::int64_t>(begin)});
  }

  /// An enumeration between points, or a number that is one.
  void check_value(std::string_view word) const {
    if (word.size() > 2 && word.front() == '.' && word.back() == '.') return;
    const std::string_view digits = word.substr(word.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool tiny =
        error == std::errc::result_out_of_range && word.find("E-") != std::string_view::npos;  // 0
    const bool large = error == std::errc::result_out_of_range && !tiny;
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size() ||
        (!large && !std::isfinite(value)))
      fail("'" + std::string(word.substr(0, 40)) + "' is no number");
    if (large || std::abs(value) > kLargest)
      fail("the number " + std::string(word.substr(0, 40)) + " is beyond 1e100");
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<StepToken>& tokens_;
  std::vector<StepEntity>& entities_;
};

}  // namespace

StepFile::StepFile(std::string text) : text_(std::move(text)) {
  Parser(text_, tokens_, entities_).run();
  number_.reserve(entities_.size());
  for (std::size_t i = 0; i < entities_.size(); ++i)
    if (!number_.emplace(entities_[i].id, i).second)
      throw std::runtime_error("two entities are named #" + std::to_string(entities_[i].id));
}

std::size_t StepFile::find(std::int64_t id) const {
  const auto at = number_.find(id);
  return at == number_.end() ? npos : at->second;
}

std::vector<std::size_t> StepFile::references(const StepEntity& entity) const {
  std::vector<std::size_t> out;
  for (const StepRecord& record : entity.records)
    for (std::size_t t = record.begin; t < record.end; ++t)
      if (tokens_[t].kind == StepToken::Reference) out.push_back(find(tokens_[t].id));
  return out;
}

const StepToken* StepFile::parameter(const StepRecord& record, std::size_t i) const {
  std::size_t depth = 0;
  for (std::size_t t = record.begin; t < record.end; ++t) {
    const StepToken& token = tokens_[t];
    if (token.kind == StepToken::Close) --depth;
    if (depth == 0 && token.kind != StepToken::Open) {
      if (i == 0) return &token;
      --i;
    }
    if (token.kind == StepToken::Open) ++depth;
  }
  return nullptr;
}

std::size_t StepFile::argument(const StepRecord& record, std::size_t i) const {
  const StepToken* token = parameter(record, i);
  return token != nullptr && token->kind == StepToken::Reference ? find(token->id) : npos;
}

std::string_view StepFile::word(const StepToken& token) const {
  if (token.kind != StepToken::Value) return {};
  const std::string_view rest = std::string_view(text_).substr(token.id);
  return rest.substr(0, rest.find_first_of(" \n\r\t\f\v(),;'\"#/$*="));
}

std::optional<double> StepFile::number(const StepToken& token) const {
  if (token.kind != StepToken::Value) return std::nullopt;
  const char* begin = text_.data() + token.id;
  if (*begin == '+') ++begin;
  double value = 0;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
  if (error != std::errc{}) return std::nullopt;
  return value;
}

std::vector<double> StepFile::numbers(const StepRecord& record) const {
  std::vector<double> out;
  for (std::size_t t = record.begin; t < record.end; ++t)
    if (const auto value = number(tokens_[t])) out.push_back(*value);
  return out;
}

const StepRecord* record_of(const StepEntity& entity, std::string_view name) {
  for (const StepRecord& record : entity.records)
    if (record.name == name) return &record;
  return nullptr;
}

std::string named(const StepEntity& entity) {
  std::string text = "#" + std::to_string(entity.id);
  for (const StepRecord& record : entity.records) text += " " + std::string(record.name);
  return text;
}

}  // namespace kaboum::io
