// Files that kaboum-plan is given.

#include "input.h"

#include <kaboum/base/error.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/outcomes.h>
#include <kaboum/world/gripper.h>

namespace kaboum::tools {

execution::PlanningTask read_task(const PlanOptions& o, bool answers_kept) {
  execution::TaskFiles files = o.task;
  files.answers_kept = answers_kept;
  execution::PlanningTask task(files);
  if (task.scene() != nullptr)
    for (const std::string& note : task.scene()->notes) log(o.common.quiet, note);
  return task;
}

std::string pads_of(const execution::PlanningTask& task) {
  return task.scene() == nullptr ? std::string() : world::pads_claim(task.scene()->world);
}

std::map<std::string, std::string> read_outcomes(const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  return plan::parse_outcomes({bytes.begin(), bytes.end()}, file);
}

void require_engine_meaning(const PlanOptions& o) {
  if (o.task.engine.library != engines::Library::Own) return;
  for (const auto& option : engines::engine_options())
    if (option.name != "engine" && o.stated.contains(option.name))
      throw Error(ErrorCode::InvalidArgument,
                  "--" + option.name + " needs --engine with a library of others");
}

plan::Plan read_plan_file(const plan::Model& model, const PlanOptions& o) {
  const std::string& file = o.plan;
  const std::vector<char> bytes = io::read_file(file);
  plan::Plan out =
      plan::read_plan(model, std::string(bytes.begin(), bytes.end()), file == "-" ? "stdin" : file);
  if (!out.not_certified.empty())
    log(o.common.quiet, "the plan was found with contacts " + out.not_certified);
  return out;
}

}  // namespace kaboum::tools
