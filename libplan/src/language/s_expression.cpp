// The lexical level of PDDL: words and lists; comments run from ";" to the end of the line.
#include "language/s_expression.h"

namespace kaboum::plan {
namespace {

class SExpressionReader {
 public:
  explicit SExpressionReader(const Source& source) : source_(source) {}

  std::vector<SExpression> read() {
    std::vector<SExpression> all;
    for (skip(); at_ < source_.text.size(); skip()) all.push_back(expression(0));
    return all;
  }

 private:
  void skip() {
    const std::string& t = source_.text;
    while (at_ < t.size()) {
      if (t[at_] == ';') {
        while (at_ < t.size() && t[at_] != '\n') ++at_;
      } else if (t[at_] == ' ' || t[at_] == '\t' || t[at_] == '\n' || t[at_] == '\r') {
        ++at_;
      } else {
        return;
      }
    }
  }

  SExpression expression(int depth) {
    if (depth > kMaximumNesting) source_.fail(at_, "nested too deeply");
    SExpression e;
    e.location = {&source_, at_};
    const std::string& t = source_.text;
    if (t[at_] == ')') source_.fail(at_, "')' without '('");
    if (t[at_] != '(') {
      // A variable begins a word of its own: "(aircraft?a)".
      while (at_ < t.size() && !(t[at_] == '?' && !e.word.empty()) &&
             std::string_view("() \t\r\n;").find(t[at_]) == std::string_view::npos) {
        const char c = t[at_++];
        e.word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      }
      return e;
    }
    const std::size_t opened = at_++;
    e.list = true;
    for (skip(); at_ < t.size() && t[at_] != ')'; skip()) e.items.push_back(expression(depth + 1));
    if (at_ >= t.size()) source_.fail(opened, "'(' is never closed");
    ++at_;
    return e;
  }

  const Source& source_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<SExpression> read_s_expressions(const Source& source) {
  return SExpressionReader(source).read();
}

}  // namespace kaboum::plan
