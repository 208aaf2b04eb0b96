// kaboum-plan show --html and kaboum-plan page: pages of plans and runs as files.

#include "page.h"

#include <kaboum/base/error.h>
#include <kaboum/execution/plan_page.h>
#include <kaboum/execution/run_page.h>
#include <kaboum/execution/task_options.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/scene.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"
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

CLI::App* add_page_command(CLI::App& app, PlanOptions& o) {
  CLI::App* p = app.add_subcommand(
      "page",
      "Show a run that a robot has carried out: one page for a browser, from the run's journal "
      "(docs/pages.md#runs)");
  p->add_option("JOURNAL", o.driver.replayed, "What run --journal wrote")
      ->required()
      ->type_name("FILE");
  p->add_option("--scene", o.task.scene, "The scene of the run")->required()->type_name("FILE");
  p->add_option("-o,--output", o.run_page, "The page; no network is needed")
      ->required()
      ->check(page_name())
      ->type_name("FILE");
  add_request_options(*p, execution::page_options(), o.page, o.stated);
  add_common_options(*p, o.common);
  return p;
}

int write_run_page(const PlanOptions& o) {
  const world::SceneFile scene = world::read_scene(o.task.scene);
  std::vector<std::string> inputs = scene.inputs;
  inputs.push_back(o.driver.replayed);
  require_apart({{"--output", o.run_page}, {"--report", o.common.report}}, inputs);
  for (const std::string& note : scene.notes) log(o.common.quiet, note);
  const std::vector<std::string> lines = execution::journal_lines(o.driver.replayed);
  const execution::PlanPage page =
      execution::run_page(scene.world, o.task.scene, lines, o.page.packages);
  for (const std::string& note : page.notes) log(o.common.quiet, note);
  io::write_file(o.run_page, page.html);
  write_report(o.common, "kaboum-plan",
               {{"command", "page"},
                {"scene", o.task.scene},
                {"entries", lines.size()},
                {"notes", page.notes}});
  return kDone;
}

}  // namespace kaboum::tools
