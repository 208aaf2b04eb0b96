#pragma once

#include <kaboum/manipulation/answer_cache.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/plan.h>
#include <kaboum/plan/replan.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "explain.h"
#include "options.h"

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

/// What is noted of external functions during a search.
struct ExternalWatch {
  Explanation explanation;
  std::unique_ptr<manipulation::AnswerCache> cache;  ///< of a scene's functions; may be none
  std::string key;                                   ///< where it is kept

  /// Keeps what came to the cache for the next run.
  void save() const;
};

/// The texts; external functions of a scene, of programs and of shared libraries are bound where
/// some are given.
/// @param watch  filled, if it is given; answers are taken from the cache then.
/// @throws Error as read_scene, start_process and load_plugin.
plan::TaskTexts read_task(const PlanOptions& options, ExternalWatch* watch = nullptr);

/// The model of these. @throws Error as read_task and plan::load.
plan::Model load_model(const PlanOptions& options, ExternalWatch* watch = nullptr);

/// The language that `name` says, else that of the file's name.
/// @throws Error{InvalidArgument} naming the option when there is none.
plan::Language language_of(const std::string& file, const std::string& name, const char* option);

/// A file of outcomes. @throws Error{InvalidInput} as parse_outcomes.
std::map<std::string, std::string> read_outcomes(const std::string& file);

/// @throws Error{InvalidInput} as plan::read_plan.
plan::Plan read_plan_file(const plan::Model& model, const std::string& file);

/// "500M", "2G", "1000000": bytes; 0 for none.
/// @throws Error{InvalidArgument}
std::size_t parse_memory(const std::string& text);

}  // namespace kaboum::tools
