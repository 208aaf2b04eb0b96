// kaboum-plan show --html: the page of a plan as a file.

#include "page.h"

#include <kaboum/base/error.h>
#include <kaboum/execution/plan_page.h>
#include <kaboum/io/mesh_io.h>

#include "input.h"

namespace kaboum::tools {

int write_page(const PlanOptions& o) {
  const execution::PlanningTask task = read_task(o);
  if (task.scene() == nullptr)
    throw Error(ErrorCode::InvalidArgument, "--html needs --scene: what is there to be seen");
  std::vector<std::string> inputs = task.scene()->inputs;
  inputs.insert(inputs.end(), {o.plan, o.task.domain, o.task.problem});
  require_apart({{"--html", o.html}}, inputs);
  const plan::Model model = task.load();
  const execution::PlanPage page = execution::plan_page(
      task, model, read_plan_file(model, o), {.tree = o.tree, .packages = o.page.packages});
  for (const std::string& note : page.notes) log(o.common.quiet, note);
  io::write_file(o.html, page.html);
  return kDone;
}

}  // namespace kaboum::tools
