// kaboum-plan solve, check, show and convert.

#include "commands.h"

#include <kaboum/base/error.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/plan.h>
#include <kaboum/plan/solve_options.h>

#include <chrono>
#include <filesystem>
#include <iostream>

#include "common/result_files.h"
#include "explain.h"
#include "input.h"
#include "page.h"

namespace kaboum::tools {
namespace {

Json statistics_json(const plan::Statistics& s) {
  Json j = {
      {"states_expanded", s.expanded},
      {"states_generated", s.generated},
      {"states_kept", s.states},
      {"search_bytes", s.state_bytes},
      {"bytes_per_state",
       s.states == 0 ? 0.0 : static_cast<double>(s.state_bytes) / static_cast<double>(s.states)},
      {"ground_actions", s.ground_actions},
      {"external_calls", s.external_calls},
      {"external_s", s.external_seconds},
      {"searches", s.searches},
      {"dead_ends", s.dead_ends},
      {"subplans_reused", s.reused},
      {"depth", s.depth}};
  if (s.initial_estimate) j["initial_estimate"] = *s.initial_estimate;
  return j;
}

Json size_json(const plan::PlanSize& s) {
  return {{"nodes", s.nodes},   {"branches", s.branches},    {"actions_in_tree", s.tree_actions},
          {"leaves", s.leaves}, {"longest_path", s.longest}, {"cost", s.cost}};
}

Json geometry_json(const manipulation::GeometryCounters& c) {
  return {{"ik_calls", c.ik_calls},
          {"ik_s", c.ik_seconds},
          {"paths", c.paths},
          {"predicate_calls", c.predicate_calls},
          {"positive", c.positive},
          {"path_s", c.path_seconds},
          {"volumes", c.volumes},
          {"volume_bodies", c.volume_bodies},
          {"volume_triangles", c.volume_triangles},
          {"volume_s", c.volume_seconds},
          {"volume_tests", c.volume_tests},
          {"volume_test_s", c.volume_test_seconds}};
}

Json engine_json(const PlanOptions& o) {
  return {{"name", engines::name_of(o.task.engine.library)},
          {"title", engines::title_of(o.task.engine.library)},
          {"shapes", value_of(engines::engine_options(), "engine-shapes", o.task.engine)},
          {"step", o.task.engine.step},
          {"certified", false}};
}

/// What is said of an outcome where there is no plan, and its exit code.
struct Verdict {
  std::string sentence;
  int code;
};

Verdict verdict(const plan::Solution& s) {
  switch (s.outcome) {
    case plan::Outcome::Solved:
      return {"", kDone};
    case plan::Outcome::Unsolvable:
      return {s.refused.empty() ? "unsolvable: every possibility was tried"
                                : "unsolvable with what external functions answer: " + s.refused,
              kNo};
    case plan::Outcome::NotInferred:
      return {
          "no plan with what the knowledge state can infer; it is not proved that there is "
          "none: " +
              s.lost,
          kNotInferred};
    case plan::Outcome::Limit:
      break;
  }
  return {"no plan found: " + s.limit, kLimit};
}

/// @throws Error{InvalidArgument} for an extension that names none of them.
std::string drawing_format(const PlanOptions& o) {
  if (!o.output_format.empty()) return o.output_format;
  const std::string extension = std::filesystem::path(o.output).extension().string();
  if (extension == ".svg") return "svg";
  if (extension == ".dot" || extension == ".gv") return "dot";
  if (extension.empty() || extension == ".txt") return "text";
  throw Error(ErrorCode::InvalidArgument,
              o.output +
                  ": plans are drawn as .svg, .dot, .gv or .txt; give such a name, or "
                  "--output-format");
}

}  // namespace

int solve(const PlanOptions& o) {
  require_engine_meaning(o);
  const auto start = std::chrono::steady_clock::now();
  const execution::PlanningTask task = read_task(o, !o.no_cache);
  const plan::Model model = task.load();
  plan::SolveOptions options = o.search;
  if (!o.assume.empty()) options.assumed = read_outcomes(o.assume);
  Progress progress(o.common.quiet);
  options.progress = [&](const plan::Statistics& s) {
    progress.show(std::to_string(s.expanded) + " states expanded, depth " +
                  std::to_string(s.depth) + ", " + std::to_string(s.state_bytes >> 20U) + " MiB");
  };
  const double loaded = user_seconds();
  const plan::Solution solution = plan::solve(model, options);
  const double solved = user_seconds();
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Verdict said = verdict(solution);
  const std::string engine = engines::words_of(o.task.engine);
  Json report = {{"command", "solve"},
                 {"domain", o.task.domain},
                 {"problem", o.task.problem},
                 {"search", value_of(plan::solve_options(), "search", o.search)},
                 {"assumed", options.assumed},
                 {"status", plan::name_of(solution.outcome)},
                 {"limit", solution.limit},
                 {"lost", solution.lost},
                 {"refused", solution.refused},
                 {"scene", task.files().scene},
                 {"statistics", statistics_json(solution.statistics)}};
  if (!o.task.margin.margins.empty()) report["margins"] = words_of(o.task.margin);
  if (!engine.empty()) report["engine"] = engine_json(o);
  task.keep_answers();
  // An engine's answers are no claim.
  const std::string pads = engine.empty() ? pads_of(task) : std::string();
  if (!pads.empty()) report["claim"] = pads;
  if (task.scene() != nullptr) {
    report["geometry"] = geometry_json(task.counters());
    report["geometry"]["answers_reused"] = task.answers_reused();
  }
  if (o.explain) {
    const Explanation explanation =
        explain(model, task.failures(), options, solution.outcome == plan::Outcome::Solved);
    report["explanation"] = failures_json(explanation);
    report["explanation_of_goal"] = goal_json(explanation.goal);
    std::cerr << explanation_text(explanation);
  }
  plan::PlanSize size;
  std::string text;
  if (solution.outcome == plan::Outcome::Solved) {
    size = plan::measure(model, solution.plan);
    report["plan"] = size_json(size);
    plan::Plan graph = o.tree ? plan::expand_tree(solution.plan) : solution.plan;
    graph.not_certified = engine;
    text = plan::write_plan(model, graph);
  }
  report["resources"] = {{"user_seconds_searching", solved - loaded}, {"wall_seconds", wall}};
  write_together(
      {{o.common.report, [&] { write_report(o.common, "kaboum-plan", report); }},
       {text.empty() ? std::string() : o.output, [&] { io::write_file(o.output, text); }}});
  if (solution.outcome == plan::Outcome::Solved) {
    const std::size_t n = options.assumed.size();
    log(o.common.quiet, (n == 0 ? "solved: "
                                : "solved under " + std::to_string(n) +
                                      (n == 1 ? " assumption: " : " assumptions: ")) +
                            std::to_string(size.nodes) + " nodes, " + std::to_string(size.leaves) +
                            " leaves, longest path " + std::to_string(size.longest) + " actions" +
                            (engine.empty() ? "" : ", contacts " + engine) +
                            (pads.empty() ? "" : "; motions are " + pads));
    return kDone;
  }
  std::cerr << "kaboum-plan: " << said.sentence << (engine.empty() ? "" : ", contacts " + engine)
            << '\n';
  return said.code;
}

int check(const PlanOptions& o) {
  require_engine_meaning(o);
  const std::string engine = engines::words_of(o.task.engine);
  const execution::PlanningTask task = read_task(o);
  const plan::Model model = task.load();
  const plan::Plan p = read_plan_file(model, o);
  const plan::CheckResult r = [&] {
    Progress progress(o.common.quiet);
    return plan::check(model, p, plan::kMostStates, [&](std::uint64_t states) {
      if (states % 1024 == 0) progress.show(std::to_string(states) + " states replayed");
    });
  }();
  Json report = {{"command", "check"},        {"valid", r.valid},
                 {"violation", r.violation},  {"states_replayed", r.states},
                 {"ends_replayed", r.leaves}, {"plan", size_json(plan::measure(model, p))}};
  if (!engine.empty()) report["engine"] = engine_json(o);
  // An engine's answers are no claim.
  const std::string pads = engine.empty() ? pads_of(task) : std::string();
  if (!pads.empty()) report["claim"] = pads;
  write_report(o.common, "kaboum-plan", report);
  const std::string by = !engine.empty() ? ", contacts " + engine
                         : !pads.empty() ? "; motions are " + pads
                                         : "";
  if (!r.valid) {
    std::cout << "invalid: " << r.violation << by << '\n';
    return kNo;
  }
  if (!o.common.quiet)
    std::cout << "valid: every end meets the goal; " << r.states << " states replayed, " << r.leaves
              << (r.leaves == 1 ? " distinct end" : " distinct ends") << by << '\n';
  return kDone;
}

int show(const PlanOptions& o) {
  if (!o.html.empty()) return write_page(o);
  const std::string format = drawing_format(o);
  const execution::PlanningTask task = read_task(o);
  const plan::Model model = task.load();
  plan::Plan p = read_plan_file(model, o);
  if (o.tree) p = plan::expand_tree(p);
  io::write_file(o.output, format == "dot"   ? plan::plan_dot(model, p)
                           : format == "svg" ? plan::plan_svg(model, p)
                                             : plan::plan_text(model, p));
  return kDone;
}

int convert(const PlanOptions& o) {
  const plan::TaskTexts texts = execution::read_texts(o.task);
  const auto to = o.output_format.empty()    ? plan::language_from_name(o.output)
                  : o.output_format == "kpl" ? plan::Language::Kpl
                                             : plan::Language::Pddl;
  if (!to)
    throw Error(
        ErrorCode::InvalidArgument,
        o.output + ": cannot tell the language from the name; give --output-format kpl or pddl");
  io::write_file(o.output,
                 plan::convert(texts.domain, texts.problem ? &*texts.problem : nullptr, *to));
  return kDone;
}

}  // namespace kaboum::tools
