#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/plan.h>
#include <kaboum/plan/solve.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>

#include "cli.h"

namespace {

using namespace kaboum;  // the tool's own names are few

struct Options {
  std::string domain, problem, plan, output = "-", input_format, problem_format, output_format,
                                     search = "greedy";
  bool tree = false;
  double timeout = 0;
  std::string max_memory;
  tools::CommonOptions common;
};

const std::map<std::string, plan::Algorithm> kAlgorithms = {
    {"dfs", plan::Algorithm::DepthFirst},
    {"bfs", plan::Algorithm::BreadthFirst},
    {"ids", plan::Algorithm::IterativeDeepening},
    {"greedy", plan::Algorithm::Greedy},
    {"astar", plan::Algorithm::AStar}};

const std::map<std::string, plan::Language> kLanguages = {
    {"kpl", plan::Language::Kpl}, {"pddl", plan::Language::Pddl}, {"xml", plan::Language::Xml}};

plan::Language language(const std::string& file, const std::string& name, const char* option) {
  if (const auto known = kLanguages.find(name); known != kLanguages.end()) return known->second;
  if (const auto guessed = plan::language_from_name(file)) return *guessed;
  throw Error(ErrorCode::InvalidArgument, file + ": cannot tell the language from the name; give " +
                                              option + " kpl, pddl or xml");
}

plan::Text read(const std::string& file, const std::string& format, const char* option) {
  const std::vector<char> bytes = io::read_file(file);
  return {file == "-" ? "stdin" : file, std::string(bytes.begin(), bytes.end()),
          language(file, format, option)};
}

struct Texts {
  plan::Text domain;
  std::optional<plan::Text> problem;
  [[nodiscard]] const plan::Text* second() const { return problem ? &*problem : nullptr; }
};

Texts read_texts(const Options& o) {
  Texts t{read(o.domain, o.input_format, "--input-format"), {}};
  if (!o.problem.empty())
    t.problem = read(o.problem, o.problem_format.empty() ? o.input_format : o.problem_format,
                     "--problem-format");
  return t;
}

/// "500M", "2G", "1000000": bytes.
std::size_t parse_memory(const std::string& text) {
  if (text.empty()) return 0;
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  double unit = 1;
  if (used > 0 && used + 1 == text.size()) {
    const std::string units = "kKMG";
    const std::size_t at = units.find(text[used]);
    unit = at == std::string::npos ? 0 : at <= 1 ? 1024.0 : at == 2 ? 1048576.0 : 1073741824.0;
    ++used;
  }
  const double bytes = value * unit;
  if (used != text.size() || !(bytes >= 1) || bytes > 1e15)
    throw Error(ErrorCode::InvalidArgument, "--max-memory: expected a size such as 500M or 2G");
  return static_cast<std::size_t>(bytes);
}

tools::Json statistics_json(const plan::Statistics& s) {
  tools::Json j = {
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
  if (s.initial_estimate >= 0) j["initial_estimate"] = s.initial_estimate;
  return j;
}

tools::Json size_json(const plan::PlanSize& s) {
  return {{"nodes", s.nodes},   {"branches", s.branches},    {"actions_in_tree", s.tree_actions},
          {"leaves", s.leaves}, {"longest_path", s.longest}, {"cost", s.cost}};
}

int solve(const Options& o) {
  const auto start = std::chrono::steady_clock::now();
  const Texts texts = read_texts(o);
  const plan::Model model = plan::load(texts.domain, texts.second());
  plan::SolveOptions options;
  options.algorithm = kAlgorithms.at(o.search);
  options.timeout = o.timeout;
  options.max_memory = parse_memory(o.max_memory);
  tools::Progress progress(o.common.quiet);
  options.progress = [&](const plan::Statistics& s) {
    progress.show(std::to_string(s.expanded) + " states expanded, depth " +
                  std::to_string(s.depth) + ", " + std::to_string(s.state_bytes >> 20U) + " MiB");
  };
  const double loaded = tools::user_seconds();
  const plan::Solution solution = plan::solve(model, options);
  const double solved = tools::user_seconds();
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const char* status = solution.outcome == plan::Outcome::Solved       ? "solved"
                       : solution.outcome == plan::Outcome::Unsolvable ? "unsolvable"
                                                                       : "limit";
  tools::Json report = {{"command", "solve"},
                        {"domain", o.domain},
                        {"problem", o.problem},
                        {"search", o.search},
                        {"status", status},
                        {"limit", solution.limit},
                        {"statistics", statistics_json(solution.statistics)}};
  plan::PlanSize size;
  if (solution.outcome == plan::Outcome::Solved) {
    size = plan::measure(model, solution.plan);
    report["plan"] = size_json(size);
    const plan::Plan& graph = solution.plan;
    const std::string text = plan::write_plan(model, o.tree ? plan::expand_tree(graph) : graph);
    io::write_file(o.output, text);
  }
  report["resources"] = {{"user_seconds_searching", solved - loaded}, {"wall_seconds", wall}};
  tools::write_report(o.common, "kaboum-plan", report);
  if (solution.outcome == plan::Outcome::Solved) {
    tools::log(o.common.quiet, "solved: " + std::to_string(size.nodes) + " nodes, " +
                                   std::to_string(size.leaves) + " leaves, longest path " +
                                   std::to_string(size.longest) + " actions");
    return tools::kDone;
  }
  std::cerr << "kaboum-plan: "
            << (solution.outcome == plan::Outcome::Unsolvable
                    ? "unsolvable: every possibility was tried"
                    : "no plan found: " + solution.limit)
            << '\n';
  return solution.outcome == plan::Outcome::Unsolvable ? tools::kNo : tools::kLimit;
}

plan::Plan load_plan(const plan::Model& model, const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  return plan::read_plan(model, std::string(bytes.begin(), bytes.end()),
                         file == "-" ? "stdin" : file);
}

int check(const Options& o) {
  const Texts texts = read_texts(o);
  const plan::Model model = plan::load(texts.domain, texts.second());
  const plan::Plan p = load_plan(model, o.plan);
  const plan::CheckResult r = plan::check(model, p);
  tools::write_report(o.common, "kaboum-plan",
                      {{"command", "check"},
                       {"valid", r.valid},
                       {"violation", r.violation},
                       {"states_replayed", r.states},
                       {"ends_replayed", r.leaves},
                       {"plan", size_json(plan::measure(model, p))}});
  if (!r.valid) {
    std::cout << "invalid: " << r.violation << '\n';
    return tools::kNo;
  }
  if (!o.common.quiet)
    std::cout << "valid: every end meets the goal; " << r.states << " states replayed, " << r.leaves
              << (r.leaves == 1 ? " distinct end\n" : " distinct ends\n");
  return tools::kDone;
}

/// @throws Error{InvalidArgument} for an extension that names none of them.
std::string drawing_format(const Options& o) {
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

int show(const Options& o) {
  const std::string format = drawing_format(o);
  const Texts texts = read_texts(o);
  const plan::Model model = plan::load(texts.domain, texts.second());
  plan::Plan p = load_plan(model, o.plan);
  if (o.tree) p = plan::expand_tree(p);
  io::write_file(o.output, format == "dot"   ? plan::plan_dot(model, p)
                           : format == "svg" ? plan::plan_svg(model, p)
                                             : plan::plan_text(model, p));
  return tools::kDone;
}

int convert(const Options& o) {
  const Texts texts = read_texts(o);
  const plan::Language to = language(o.output, o.output_format, "--output-format");
  io::write_file(o.output, plan::convert(texts.domain, texts.second(), to));
  return tools::kDone;
}

void add_inputs(CLI::App& app, Options& o) {
  app.add_option("DOMAIN", o.domain, "Domain file (.kpl, .pddl, .xml), or - for stdin")
      ->required()
      ->type_name("FILE");
  app.add_option("--input-format", o.input_format,
                 "Language of DOMAIN (and PROBLEM) [by extension]")
      ->check(CLI::IsMember({"kpl", "pddl", "xml"}))
      ->type_name("NAME");
  app.add_option("--problem-format", o.problem_format, "Language of PROBLEM [by extension]")
      ->check(CLI::IsMember({"kpl", "pddl", "xml"}))
      ->type_name("NAME");
}

void add_problem(CLI::App& app, Options& o) {
  app.add_option("PROBLEM", o.problem, "Problem file, if the domain file does not hold it")
      ->type_name("FILE");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Plans actions under incomplete knowledge: contingent plans with sensing.",
               "kaboum-plan");
  app.require_subcommand(1);
  Options o;

  CLI::App* s = app.add_subcommand("solve", "Find a plan");
  add_inputs(*s, o);
  add_problem(*s, o);
  s->add_option(
       "--search", o.search,
       "greedy: a plan, soon; astar: least cost; bfs, ids: fewest steps; dfs: any plan. With "
       "sensing, the last three minimise parts, not the whole")
      ->check(CLI::IsMember({"dfs", "bfs", "ids", "greedy", "astar"}))
      ->capture_default_str()
      ->type_name("NAME");
  s->add_option("-o,--output", o.output, "The plan (JSON); - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  s->add_flag("--tree", o.tree, "Write the plan as a tree, without shared sub-plans");
  s->add_option("--timeout", o.timeout, "Give up after this many seconds [never]")
      ->check([](const std::string& text) {
        double seconds = 0;
        const bool good = CLI::detail::lexical_cast(text, seconds) && seconds > 0;
        return good ? std::string() : "expected a number of seconds above 0, not " + text;
      })
      ->type_name("S");
  s->add_option("--max-memory", o.max_memory,
                "Give up when grounding and search hold this much, e.g. 500M or 2G [no limit]")
      ->type_name("SIZE");
  tools::add_common_options(*s, o.common);

  CLI::App* c =
      app.add_subcommand("check", "Replay every branch of a plan, independently of the planner");
  add_inputs(*c, o);
  add_problem(*c, o);
  c->add_option("--plan", o.plan, "The plan to check, or -")->required()->type_name("FILE");
  tools::add_common_options(*c, o.common);

  CLI::App* w = app.add_subcommand("show", "Print or draw a plan");
  add_inputs(*w, o);
  add_problem(*w, o);
  w->add_option("--plan", o.plan, "The plan to show, or -")->required()->type_name("FILE");
  w->add_option("-o,--output", o.output, "Where to; - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  w->add_option("--output-format", o.output_format,
                "text, dot or svg [by extension: .dot, .gv, .svg, .txt; text without one]")
      ->check(CLI::IsMember({"text", "dot", "svg"}))
      ->type_name("NAME");
  w->add_flag("--tree", o.tree, "Expand shared sub-plans");
  tools::add_common_options(*w, o.common);

  CLI::App* v =
      app.add_subcommand("convert", "Translate a domain (and problem) between kpl, PDDL and XML");
  add_inputs(*v, o);
  add_problem(*v, o);
  v->add_option("-o,--output", o.output, "Where to; - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  v->add_option("--output-format", o.output_format, "kpl, pddl or xml [by extension]")
      ->check(CLI::IsMember({"kpl", "pddl", "xml"}))
      ->type_name("NAME");
  tools::add_common_options(*v, o.common);

  app.footer(
      "Exit codes: 0 done; 1 unsolvable, or the plan is invalid; 2 usage; 3 bad input; 4 output "
      "failed; "
      "6 internal error; 7 time, memory or size limit reached.");
  return tools::run(app, argc, argv, [&] {
    if (s->parsed()) return solve(o);
    if (c->parsed()) return check(o);
    if (w->parsed()) return show(o);
    return convert(o);
  });
}
