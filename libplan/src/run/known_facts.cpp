// What is known in words.
#include <kaboum/plan/known_facts.h>

namespace kaboum::plan {
namespace {

std::string literal(const KnownFacts::Term& atom, bool truth) {
  return (truth ? "" : "!") + text_of(atom);
}

}  // namespace

std::string text_of(const KnownFacts::Term& term) {
  std::string out = term.front();
  for (std::size_t i = 1; i < term.size(); ++i) out.append(i > 1 ? ", " : "(").append(term[i]);
  return term.size() > 1 ? out + ")" : out;
}

std::set<std::string> sentences_of(const KnownFacts& known) {
  std::set<std::string> out;
  for (const auto& [atom, truth] : known.atoms) out.insert(literal(atom, truth));
  for (const auto& [term, value] : known.values) out.insert(text_of(term) + " = " + value);
  for (const auto& [term, values] : known.excluded)
    for (const std::string& value : values) out.insert(text_of(term) + " != " + value);
  for (const std::set<KnownFacts::Term>& atoms : known.exclusive) {
    std::string text;
    for (const KnownFacts::Term& atom : atoms)
      text += (text.empty() ? "one of " : ", ") + text_of(atom);
    out.insert(std::move(text));
  }
  for (const auto& literals : known.some) {
    std::string text;
    for (const auto& [atom, truth] : literals)
      text += (text.empty() ? "" : " or ") + literal(atom, truth);
    out.insert(std::move(text));
  }
  return out;
}

}  // namespace kaboum::plan
