// The options of kaboum-plan, by command.

#include "options.h"

#include <kaboum/execution/task_options.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"

namespace kaboum::tools {

void add_inputs(CLI::App& app, PlanOptions& o) {
  app.add_option("DOMAIN", o.task.domain,
                 "Domain file (.kpl, .pddl), or - for stdin; or a task of usual actions (.task)")
      ->required()
      ->type_name("FILE");
  add_request_options(app,
                      options_named(execution::task_options(), {"input-format", "problem-format"}),
                      o.task, o.stated);
}

void add_problem(CLI::App& app, PlanOptions& o) {
  app.add_option("PROBLEM", o.task.problem, "Problem file, if the domain file does not hold it")
      ->type_name("FILE");
}

CLI::Option* add_scene(CLI::App& app, PlanOptions& o) {
  add_request_options(
      app, options_named(execution::task_options(), {"process", "process-timeout", "plugin"}),
      o.task, o.stated);
  return app
      .add_option("--scene", o.task.scene,
                  "Scene whose geometry answers external functions (docs/planning/geometry.md) "
                  "[that of a .task; else externals are tables]")
      ->type_name("FILE");
}

CLI::App* add_solve_command(CLI::App& app, PlanOptions& o) {
  CLI::App* s = app.add_subcommand("solve", "Find a plan");
  add_inputs(*s, o);
  add_problem(*s, o);
  add_scene(*s, o);
  add_request_options(*s, execution::task_margin_options(), o.task, o.stated);
  add_request_options(*s, execution::task_engine_options(), o.task, o.stated);
  add_request_options(*s, plan::solve_options(), o.search, o.stated);
  s->add_option("-o,--output", o.output, "The plan (JSON); - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  s->add_flag("--tree", o.tree, "Write the plan as a tree, without shared sub-plans");
  s->add_option("--assume", o.assume,
                "Outcomes of sensing that the plan needs branches for alone, a JSON file "
                "{\"isSpillable(o1)\": false, ...}: where one is wrong, run plans again")
      ->type_name("FILE");
  s->add_flag("--explain", o.explain,
              "Say which calls of external functions returned no value, how often, and why; where "
              "there is no plan, also what of the goal is in the way");
  s->add_flag("--no-cache", o.no_cache,
              "Ask a scene's functions anew, and keep nothing for the next run ($KABOUM_CACHE)");
  add_common_options(*s, o.common);
  return s;
}

CLI::App* add_check_command(CLI::App& app, PlanOptions& o) {
  CLI::App* c =
      app.add_subcommand("check", "Replay every branch of a plan, independently of the planner");
  add_inputs(*c, o);
  add_problem(*c, o);
  add_scene(*c, o);
  add_request_options(*c, execution::task_margin_options(), o.task, o.stated);
  add_request_options(*c, execution::task_engine_options(), o.task, o.stated);
  c->add_option("--plan", o.plan, "The plan to check, or -")->required()->type_name("FILE");
  add_common_options(*c, o.common);
  return c;
}

CLI::App* add_show_command(CLI::App& app, PlanOptions& o) {
  CLI::App* w = app.add_subcommand("show", "Print or draw a plan");
  add_inputs(*w, o);
  add_problem(*w, o);
  add_scene(*w, o);
  w->add_option("--plan", o.plan, "The plan to show, or -")->required()->type_name("FILE");
  w->add_option("-o,--output", o.output, "Where to; - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  w->add_option("--output-format", o.output_format,
                "text, dot or svg [by extension: .dot, .gv, .svg, .txt; text without one]")
      ->check(CLI::IsMember({"text", "dot", "svg"}))
      ->type_name("NAME");
  w->add_flag("--tree", o.tree, "Expand shared sub-plans");
  w->add_option("--html", o.html,
                "Instead: one page that plays the plan's execution in the scene of --scene, every "
                "branch, for a browser; no network is needed")
      ->check(page_name())
      ->excludes("--output-format")
      ->excludes("--output")
      ->type_name("FILE");
  add_request_options(*w, execution::page_options(), o.page, o.stated);
  add_common_options(*w, o.common);
  return w;
}

CLI::App* add_convert_command(CLI::App& app, PlanOptions& o) {
  CLI::App* v =
      app.add_subcommand("convert", "Translate a domain (and problem) between kpl and PDDL");
  add_inputs(*v, o);
  add_problem(*v, o);
  v->add_option("-o,--output", o.output, "Where to; - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  v->add_option("--output-format", o.output_format, "kpl or pddl [by extension]")
      ->check(CLI::IsMember({"kpl", "pddl"}))
      ->type_name("NAME");
  add_common_options(*v, o.common);
  return v;
}

}  // namespace kaboum::tools
