// Atoms and terms as users write them in files of outcomes and assumptions.
#include "plan/named_fact.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// The name and the arguments; none at all: it is not written as an atom is.
std::vector<std::string> parts_of_fact(const std::string& text) {
  const std::string all = trimmed(text);
  const std::size_t open = all.find('(');
  std::vector<std::string> out = {trimmed(all.substr(0, open))};
  if (out[0].empty() || out[0].find_first_of("), ") != std::string::npos) return {};
  if (open == std::string::npos) return out;
  if (all.back() != ')') return {};
  const std::string inner = all.substr(open + 1, all.size() - open - 2);
  if (trimmed(inner).empty()) return out;
  for (std::size_t begin = 0; begin <= inner.size();) {
    const std::size_t end = std::min(inner.find(',', begin), inner.size());
    out.push_back(trimmed(inner.substr(begin, end - begin)));
    if (out.back().empty() || out.back().find_first_of("()") != std::string::npos) return {};
    begin = end + 1;
  }
  return out;
}

}  // namespace

NamedFact read_named_fact(const Model& model, const std::string& text, const std::string& value,
                          const std::function<void(const std::string&)>& refuse) {
  const std::vector<std::string> parts = parts_of_fact(text);
  if (parts.empty()) refuse("which is no atom or term");
  NamedFact out;
  const auto find = [&](const std::vector<Symbol>& symbols) {
    const auto found = std::ranges::find(symbols, parts.front(), &Symbol::name);
    out.symbol = static_cast<Index>(found - symbols.begin());
    return found != symbols.end();
  };
  out.function = !find(model.predicates);
  if (out.function && !find(model.functions)) refuse("which the model does not have");
  const Symbol& symbol = (out.function ? model.functions : model.predicates)[out.symbol];
  if (parts.size() - 1 != symbol.parameters.size()) refuse("which has other arguments");
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto object = std::ranges::find(model.objects, parts[i], &Object::name);
    if (object == model.objects.end()) refuse("but there is no '" + parts[i] + "'");
    out.arguments.push_back(static_cast<Index>(object - model.objects.begin()));
  }
  if (!out.function && value != "true" && value != "false")
    refuse("which is true or false, not " + value);
  return out;
}

}  // namespace kaboum::plan
