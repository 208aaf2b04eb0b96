// Files that kaboum-plan is given.

#include "input.h"

#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/outcomes.h>

namespace kaboum::tools {

execution::PlanningTask read_task(const PlanOptions& o, bool answers_kept) {
  execution::TaskFiles files = o.task;
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

}  // namespace kaboum::tools
