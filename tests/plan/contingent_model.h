#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace kaboum::plan::test {

/// A random contingent task: effects that are conditional in the world, disjunctions, sensing.
class ContingentGenerator {
 public:
  /// @param deletions  also among the effects under conditions of the world.
  explicit ContingentGenerator(std::uint32_t seed, bool deletions = false)
      : random_(seed), deletions_(deletions) {}

  std::string model() {
    std::string text =
        "types: v\nconstants: v a, b, c\npredicates: p0, p1, p2, p3, q(v)\nfunctions: f : v\n"
        "closed: p3, q\ninit:\n";
    for (const char* atom : {"p0", "p1", "p2"})
      if (pick(3) == 0) text += std::string("  K(") + (pick(2) ? "!" : "") + atom + ")\n";
    if (pick(2)) text += "  Kx(q(a) | q(b)" + std::string(pick(2) ? " | q(c)" : "") + ")\n";
    if (pick(3) == 0) text += "  Or(" + literal() + " | " + literal() + ")\n";
    if (pick(3) == 0) text += "  Or(" + literal() + " | " + literal() + ")\n";
    if (pick(2)) text += "  K(f = " + object() + ")\n";
    const int actions = 3 + pick(3);
    for (int i = 0; i < actions; ++i) {
      const bool parameter = pick(2) != 0;
      variable_ = parameter ? "?y" : "";
      text += "action act" + std::to_string(i) + (parameter ? "(?y : v)" : "") +
              "\n  preconds: " + (pick(3) ? condition() : "true") + "\n  effects: " + effects() +
              "\n";
    }
    variable_.clear();
    return text + "goal: " + condition() + (pick(2) ? " & " + condition() : "") + "\n";
  }

 private:
  int pick(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  std::string object() {
    if (!variable_.empty() && pick(2)) return variable_;
    return std::string(1, static_cast<char>('a' + pick(3)));
  }
  std::string atom() {
    const int n = pick(6);
    return n < 4 ? "p" + std::to_string(n) : "q(" + object() + ")";
  }
  std::string literal() { return (pick(2) ? "!" : "") + atom(); }
  std::string condition() {
    const auto one = [&] {
      return pick(5) ? "K(" + literal() + ")"
                     : "K(f " + std::string(pick(3) ? "" : "!") + "= " + object() + ")";
    };
    const int n = pick(6);
    if (n == 0) return "(" + one() + " | " + one() + ")";
    return n < 3 ? one() + " & " + one() : one();
  }
  std::string change() {
    if (deletions_ && pick(4) == 0)
      return pick(3) ? "del(Kf, " + literal() + ")" : "del(Kf, f = " + object() + ")";
    return pick(5) ? "add(Kf, " + literal() + ")" : "add(Kf, f = " + object() + ")";
  }
  std::string effects() {
    if (pick(3) == 0) return pick(4) ? "add(Kw, " + atom() + ")" : "add(Kv, f)";
    std::string text;
    for (int n = 1 + pick(3); n > 0; --n) {
      text += text.empty() ? "" : ", ";
      const int kind = pick(8);
      if (kind < 4)
        text += "whenever " + condition() + " => { " + change() + (pick(2) ? ", " + change() : "") +
                " }";
      else if (kind == 4)
        text += "maybe(Kf, " + literal() + ")";
      else if (kind == 5)
        text += "add(Kw, " + atom() + ")";
      else
        text += change();
    }
    return text;
  }

  std::mt19937 random_;
  bool deletions_;
  std::string variable_;
};

}  // namespace kaboum::plan::test
