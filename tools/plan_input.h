#pragma once

#include <kaboum/plan/load.h>
#include <kaboum/plan/plan.h>

#include <cstddef>
#include <optional>
#include <string>

#include "plan_options.h"

/// What kaboum-plan reads.
namespace kaboum::tools {

/// A domain, and a problem where it is a file of its own.
struct PlanTexts {
  plan::Text domain;
  std::optional<plan::Text> problem;
  [[nodiscard]] const plan::Text* second() const { return problem ? &*problem : nullptr; }
};
/// @throws Error on files that cannot be read, or are of no known language.
PlanTexts read_texts(const PlanOptions& options);

/// The model of the texts; external functions of a scene are bound where one is given.
/// @throws Error as plan::load and read_scene.
plan::Model load_model(const PlanOptions& options);

/// The language that `name` says, else that of the file's name.
/// @throws Error{InvalidArgument} naming the option when there is none.
plan::Language language_of(const std::string& file, const std::string& name, const char* option);

/// @throws Error{InvalidInput} as plan::read_plan.
plan::Plan read_plan_file(const plan::Model& model, const std::string& file);

/// "500M", "2G", "1000000": bytes; 0 for none.
/// @throws Error{InvalidArgument}
std::size_t parse_memory(const std::string& text);

}  // namespace kaboum::tools
