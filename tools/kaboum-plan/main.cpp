// The program kaboum-plan: its subcommands.

#include "commands.h"

#include <CLI/CLI.hpp>

#include "page.h"
#include "run.h"

int main(int argc, char** argv) {
  using namespace kaboum;
  CLI::App app("Plans actions under incomplete knowledge: contingent plans with sensing.",
               "kaboum-plan");
  app.require_subcommand(1);
  tools::PlanOptions o;
  const CLI::App* solve = tools::add_solve_command(app, o);
  const CLI::App* check = tools::add_check_command(app, o);
  const CLI::App* show = tools::add_show_command(app, o);
  const CLI::App* run = tools::add_run_command(app, o);
  const CLI::App* page = tools::add_page_command(app, o);
  tools::add_convert_command(app, o);
  app.footer(
      "With --engine fcl, bullet or ode nothing is certified: contacts are what that library says, "
      "of motions at samples; unsolvable is no proof then "
      "(docs/algorithms/collision-engines.md).\n"
      "Exit codes: 0 done; 1 unsolvable, or the plan is invalid, or its execution is not as it "
      "should be; 2 usage; 3 bad input; 4 output "
      "failed; 5 the engine is not built; 6 internal error; 7 time, memory or size limit reached; "
      "8 no plan with what the "
      "knowledge state can infer, which is no proof.");
  return tools::run(app, argc, argv, [&] {
    if (solve->parsed()) return tools::solve(o);
    if (check->parsed()) return tools::check(o);
    if (show->parsed()) return tools::show(o);
    if (run->parsed()) return tools::run_plan(o);
    if (page->parsed()) return tools::write_run_page(o);
    return tools::convert(o);
  });
}
