#pragma once

#include <cstdint>
#include <random>
#include <string>

namespace kaboum::plan::test {

/// A random model: nullary and unary predicates, functions, nested terms; all databases; effects
/// with conditions and quantifiers.
class Generator {
 public:
  Generator(std::uint32_t seed, bool disjunctions) : random_(seed), disjunctions_(disjunctions) {}

  std::string model(int actions, int probes) {
    std::string text =
        "types: v\nconstants: v a, b, c\npredicates: p, q, r(v), x0, x1, x2\nfunctions: f : v; g : "
        "v\n"
        "init:\n";
    for (const char* atom : {"p", "q", "r(a)", "r(b)", "r(c)"}) {
      const int n = pick(4);
      if (n < 2) text += std::string("  K(") + (n == 0 ? "!" : "") + atom + ")\n";
      if (n == 2 && pick(3) == 0) text += std::string("  Kw(") + atom + ")\n";
    }
    if (pick(2)) text += "  K(f = " + object() + ")\n";
    if (pick(4) == 0) text += "  Kx(g = a | g = b)\n";
    if (pick(4) == 0) text += "  K(g != " + object() + ")\n";
    if (pick(5) == 0) text += "  Kv(g)\n";
    if (disjunctions_) {
      if (pick(2)) text += "  Kx(x0 | x1 | x2)\n";
    } else {
      text += "  K(!x0) K(!x1) K(!x2)\n";
    }
    if (pick(5) == 0) text += "  LCW(r(?o))\n";
    for (int i = 0; i < actions; ++i) {
      const bool parameter = pick(2) != 0;
      variable_ = parameter ? "?y" : "";
      text += "action act" + std::to_string(i) + (parameter ? "(?y : v)" : "") +
              "\n  preconds: " + (pick(3) ? query(1) : "true") + "\n  effects: " + effects(2) +
              "\n";
    }
    variable_.clear();
    for (int i = 0; i < probes; ++i)
      text += "action probe" + std::to_string(i) + "\n  preconds: " + query(2) + "\n  effects:\n";
    return text + "goal: " + query(1) + " & " + query(1) + "\n";
  }

 private:
  int pick(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  std::string object() {
    if (!variable_.empty() && pick(2)) return variable_;
    return std::string(1, static_cast<char>('a' + pick(3)));
  }
  /// An argument: an object, or (rarely) the value of a function.
  std::string argument() { return pick(6) ? object() : pick(2) ? "f" : "g"; }
  std::string atom() {
    switch (pick(disjunctions_ ? 5 : 3)) {
      case 0:
        return "p";
      case 1:
        return "q";
      case 2:
        return "r(" + argument() + ")";
      default:
        return "x" + std::to_string(pick(3));
    }
  }
  std::string literal() {
    if (pick(4) == 0)
      return std::string(pick(2) ? "f" : "g") + (pick(3) ? " = " : " != ") + argument();
    return (pick(2) ? "!" : "") + atom();
  }
  std::string query(int depth) {
    if (depth > 0 && pick(3) == 0) {
      switch (pick(6)) {
        case 0:
          return "(" + query(depth - 1) + " & " + query(depth - 1) + ")";
        case 1:
          return "(" + query(depth - 1) + " | " + query(depth - 1) + ")";
        case 2:
          return "(" + query(depth - 1) + " xor " + query(depth - 1) + ")";
        case 3:
          return "!" + query(depth - 1);
        default: {
          const std::string outer = variable_;
          const bool all = pick(2) != 0;
          variable_ = "?z" + std::to_string(depth);
          const std::string text = std::string(all ? "forallK(" : "existsK(") + variable_ +
                                   " : v) (" + query(depth - 1) + ")";
          variable_ = outer;
          return text;
        }
      }
    }
    switch (pick(8)) {
      case 0:
        return "Kw(" + atom() + ")";
      case 1:
        return std::string("Kv(") + (pick(2) ? "f" : "g") + ")";
      case 2:
        return std::string("Kw(") + (pick(2) ? "f" : "g") + " = " + object() + ")";
      case 3:
        return "LCW(r(?any))";
      case 4:
        return "!K(" + literal() + ")";
      default:
        return "K(" + literal() + ")";
    }
  }
  std::string update() {
    const std::string term = pick(2) ? "f" : "g";
    switch (pick(disjunctions_ ? 15 : 12)) {
      case 0:
        return "del(Kf, " + literal() + ")";
      case 1:
        return "add(Kw, " + atom() + ")";
      case 2:
        return "del(Kw, " + atom() + ")";
      case 3:
        return "add(Kv, " + term + ")";
      case 4:
        return "del(Kv, " + term + ")";
      case 5:
        return "add(LCW, r(?any))";
      case 6:
        return "del(LCW, r(?any))";
      case 7:
        return "maybe(Kf, " + literal() + ")";
      case 8:
        return "add(Kx, " + term + " = a | " + term + " = " + (pick(2) ? "b" : "c") + ")";
      case 12:
        return "add(Kx, x0 | x1 | x2)";
      case 13:
        return "add(Kx, x0 | x1)";
      case 14:
        return "del(Kx, x0 | x1 | x2)";
      default:
        return "add(Kf, " + literal() + ")";
    }
  }
  std::string effects(int depth) {
    std::string text;
    for (int n = 1 + pick(3); n > 0; --n) {
      text += text.empty() ? "" : ", ";
      // With disjunctions inference is sound, not complete: conditions would part the two for good.
      const int kind = depth > 0 ? pick(5) : 4;
      if (kind == 0 && !disjunctions_) {
        text += query(1) + " => { " + effects(depth - 1) + " }";
      } else if (kind == 1) {
        const std::string outer = variable_;
        variable_ = "?e" + std::to_string(depth);
        text += "forall(" + variable_ + " : v) { " + effects(depth - 1) + " }";
        variable_ = outer;
      } else {
        text += update();
      }
    }
    return text;
  }

  std::mt19937 random_;
  bool disjunctions_;
  std::string variable_;
};

}  // namespace kaboum::plan::test
