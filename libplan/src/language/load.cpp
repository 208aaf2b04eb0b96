// The ways into the library: texts of any language become a model, or a text of another language.
#include <kaboum/plan/load.h>

#include "language/known_state.h"
#include "language/kpl_parser.h"
#include "language/kpl_printer.h"
#include "language/pddl.h"
#include "language/resolve.h"

namespace kaboum::plan {
namespace {

syntax::Document parse(const Text& text) {
  constexpr std::size_t kLargest = 64U << 20U;
  if (text.text.size() > kLargest)
    throw Error(ErrorCode::InvalidInput, text.name + ": larger than 64 MiB");
  auto source = std::make_shared<Source>(Source{text.name, text.text});
  switch (text.language) {
    case Language::Kpl:
      return parse_kpl(std::move(source));
    case Language::Pddl:
      return parse_pddl(std::move(source));
  }
  throw Error(ErrorCode::InvalidArgument, "unknown language");
}

syntax::Document parse(const Text& domain, const Text* problem) {
  syntax::Document d = parse(domain);
  if (problem == nullptr) return d;
  syntax::Document p = parse(*problem);
  if (domain.language == Language::Pddl && problem->language == Language::Pddl)
    declare_shared_types(d, p);
  return syntax::merge(std::move(d), std::move(p));
}

/// Names that nothing declares are only found when the text is read: it must read as it was
/// written.
std::string checked_kpl(std::string text, const std::string& of) {
  std::string again;
  try {
    again = print_kpl(parse_kpl(std::make_shared<Source>(Source{"the result", text})));
  } catch (const Error& e) {
    throw Error(ErrorCode::InvalidInput, of + ": kpl cannot say a name that is used: " + e.what());
  }
  if (again != text)
    throw Error(ErrorCode::InvalidInput, of + ": kpl cannot say a name that is used");
  return text;
}

}  // namespace

std::optional<Language> language_from_name(std::string_view file_name) {
  const auto ends = [&](std::string_view e) { return file_name.ends_with(e); };
  if (ends(".kpl")) return Language::Kpl;
  if (ends(".pddl")) return Language::Pddl;
  return std::nullopt;
}

Model load(const Text& domain, const Text* problem, const ExternalBindings& bindings) {
  return resolve(parse(domain, problem), bindings);
}

Model load_from(const KnownFacts& known, const Text& domain, const Text* problem,
                const ExternalBindings& bindings) {
  syntax::Document document = parse(domain, problem);
  declare_words(known, document);
  Model model = resolve(document, bindings);
  start_from(known, model);
  return model;
}

std::string convert(const Text& domain, const Text* problem, Language to) {
  const syntax::Document d = parse(domain, problem);
  switch (to) {
    case Language::Kpl:
      return checked_kpl(print_kpl(d), domain.name);
    case Language::Pddl:
      return print_pddl(d);
  }
  throw Error(ErrorCode::InvalidArgument, "unknown language");
}

}  // namespace kaboum::plan
