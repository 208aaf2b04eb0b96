#pragma once

#include <kaboum/plan/externals.h>
#include <kaboum/plan/known_facts.h>
#include <kaboum/plan/model.h>

#include <optional>
#include <string>
#include <string_view>

namespace kaboum::plan {

enum class Language { Kpl, Pddl };

/// By the file name's extension: .kpl or .pddl; else nullopt.
std::optional<Language> language_from_name(std::string_view file_name);

/// A text and what it is called in messages.
struct Text {
  std::string name;
  std::string text;
  Language language = Language::Kpl;
};

/// Reads, merges and checks a domain and (optionally) its problem.
/// @throws Error{InvalidInput} "file:line:column: error: ..." with the line and a caret.
Model load(const Text& domain, const Text* problem, const ExternalBindings& bindings = {});

/// The same task from another state: all that is known there stands in place of the initial
/// knowledge. Words of handles are constants of this model.
/// @throws Error{InvalidInput} as above, and for names that the task does not have.
Model load_from(const KnownFacts& known, const Text& domain, const Text* problem,
                const ExternalBindings& bindings = {});

/// The same document in another language. @throws Error{InvalidInput} naming what cannot be said in
/// it.
std::string convert(const Text& domain, const Text* problem, Language to);

}  // namespace kaboum::plan
