// Files and sizes that kaboum-plan is given.

#include "input.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/outcomes.h>

#include "common/memory_size.h"

namespace kaboum::tools {
namespace {

const std::map<std::string, plan::Language> kLanguages = {{"kpl", plan::Language::Kpl},
                                                          {"pddl", plan::Language::Pddl}};

}  // namespace

plan::Language language_of(const std::string& file, const std::string& name, const char* option) {
  if (const auto known = kLanguages.find(name); known != kLanguages.end()) return known->second;
  if (const auto guessed = plan::language_from_name(file)) return *guessed;
  throw Error(ErrorCode::InvalidArgument,
              file + ": cannot tell the language from the name; give " + option + " kpl or pddl");
}

execution::TaskFiles task_files(const PlanOptions& o) {
  execution::TaskFiles out{o.domain, o.problem, o.scene};
  out.language = language_of(o.domain, o.input_format, "--input-format");
  if (!o.problem.empty())
    out.problem_language =
        language_of(o.problem, o.problem_format.empty() ? o.input_format : o.problem_format,
                    "--problem-format");
  out.plugins = o.plugins;
  out.processes = o.processes;
  out.most_seconds = o.process_timeout;
  return out;
}

execution::PlanningTask read_task(const PlanOptions& o, bool answers_kept) {
  execution::TaskFiles files = task_files(o);
  files.answers_kept = answers_kept;
  execution::PlanningTask task(files);
  if (task.scene() != nullptr)
    for (const std::string& note : task.scene()->notes) log(o.common.quiet, note);
  return task;
}

std::map<std::string, std::string> read_outcomes(const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  return plan::parse_outcomes({bytes.begin(), bytes.end()}, file);
}

plan::Plan read_plan_file(const plan::Model& model, const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  return plan::read_plan(model, std::string(bytes.begin(), bytes.end()),
                         file == "-" ? "stdin" : file);
}

std::size_t parse_memory(const std::string& text) { return parse_memory(text, "--max-memory"); }

}  // namespace kaboum::tools
