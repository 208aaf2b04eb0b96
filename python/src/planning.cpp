// Planning: kaboum.solve, check_plan, draw_plan, write_plan_page, write_run_page, run_plan and
// convert_domain, as kaboum-plan.

#include <kaboum/execution/plan_page.h>
#include <kaboum/execution/run_page.h>
#include <kaboum/execution/task_options.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/outcomes.h>
#include <kaboum/plan/solve_options.h>

#include <map>

#include "arguments.h"
#include "request_options.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

constexpr std::array<std::pair<const char*, plan::Language>, 2> kLanguages{
    {{"kpl", plan::Language::Kpl}, {"pddl", plan::Language::Pddl}}};
using Drawing = std::string (*)(const plan::Model&, const plan::Plan&, const plan::PlanProgress&);
constexpr std::array<std::pair<const char*, Drawing>, 3> kDrawings{
    {{"text", &plan::plan_text}, {"dot", &plan::plan_dot}, {"svg", &plan::plan_svg}}};

std::string text_of_file(const std::string& path) {
  const std::vector<char> bytes = io::read_file(path);
  return {bytes.begin(), bytes.end()};
}

std::string json_text(const py::handle& value) {
  return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

/// The files of a task, whose options are taken from keywords.
/// @param scene  None: none
execution::TaskFiles files_of(const py::object& domain, const py::object& problem,
                              const py::object& scene, py::dict& keywords,
                              bool keeps_apart = false) {
  execution::TaskFiles out;
  take_options(execution::task_options(), keywords, out);
  if (keeps_apart) take_options(execution::task_margin_options(), keywords, out);
  out.domain = required_path(domain, "domain");
  if (!problem.is_none()) out.problem = required_path(problem, "problem");
  if (!scene.is_none()) out.scene = required_path(scene, "scene");
  return out;
}

/// A dict of outcomes, or a file of them.
std::map<std::string, std::string> outcomes_of(const py::object& value, const char* argument) {
  if (value.is_none()) return {};
  if (const auto path = path_of(value)) return plan::parse_outcomes(text_of_file(*path), *path);
  if (!py::isinstance<py::dict>(value))
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a dict of outcomes, or a file of them");
  return plan::parse_outcomes(json_text(value), argument);
}

py::dict dict_of(const plan::PlanSize& size) {
  py::dict out;
  out["nodes"] = size.nodes;
  out["branches"] = size.branches;
  out["actions_in_tree"] = size.tree_actions;
  out["leaves"] = size.leaves;
  out["longest_path"] = size.longest;
  out["cost"] = size.cost;
  return out;
}

std::vector<Keyword> task_keywords() { return keywords_of(execution::task_options()); }
std::vector<Keyword> check_keywords() {
  return task_keywords() + keywords_of(execution::task_margin_options());
}
std::vector<Keyword> solve_keywords() {
  return keywords_of(plan::solve_options()) + check_keywords();
}
std::vector<Keyword> run_keywords() {
  return keywords_of(execution::run_options()) + task_keywords();
}
std::vector<Keyword> page_keywords() {
  return keywords_of(execution::page_options()) + task_keywords();
}

struct SolutionValue {
  std::shared_ptr<const plan::Model> model;
  plan::Solution found;
  std::vector<plan::FailedCalls::Failure> failures;
  std::vector<std::string> notes;

  [[nodiscard]] bool solved() const { return found.outcome == plan::Outcome::Solved; }
};

py::object plan_of(const SolutionValue& s) {
  if (!s.solved()) return py::none();
  return py::module_::import("json").attr("loads")(plan::write_plan(*s.model, s.found.plan));
}

py::dict statistics_of(const SolutionValue& s) {
  const plan::Statistics& n = s.found.statistics;
  py::dict out;
  out["states_expanded"] = n.expanded;
  out["states_generated"] = n.generated;
  out["states_kept"] = n.states;
  out["search_bytes"] = n.state_bytes;
  out["ground_actions"] = n.ground_actions;
  out["external_calls"] = n.external_calls;
  out["external_s"] = n.external_seconds;
  out["searches"] = n.searches;
  out["dead_ends"] = n.dead_ends;
  out["subplans_reused"] = n.reused;
  out["depth"] = n.depth;
  return out;
}

void bind_planning_class(py::module_& module) {
  py::class_<SolutionValue>(
      module, "Solution",
      R"(What became of a search for a plan. True if and only if there is a plan.)")
      .def_property_readonly(
          "outcome", [](const SolutionValue& s) { return plan::name_of(s.found.outcome); },
          "'solved'; 'unsolvable', which is proved; 'not inferred': all was tried, but the "
          "knowledge state keeps less than could be concluded; 'limit'.")
      .def_property_readonly(
          "limit", [](const SolutionValue& s) { return s.found.limit; }, "Which limit was reached.")
      .def_property_readonly(
          "refused", [](const SolutionValue& s) { return s.found.refused; },
          "The first call of an external function that was impossible, and why.")
      .def_property_readonly(
          "lost", [](const SolutionValue& s) { return s.found.lost; },
          "What the knowledge state does not keep.")
      .def_property_readonly("plan", &plan_of,
                             "The plan as its JSON (docs/planning/plans.md), or None.")
      .def_property_readonly(
          "text",
          [](const SolutionValue& s) {
            return s.solved() ? plan::plan_text(*s.model, s.found.plan) : std::string();
          },
          "The plan as an indented text, or ''.")
      .def_property_readonly(
          "size",
          [](const SolutionValue& s) -> py::object {
            if (!s.solved()) return py::none();
            return dict_of(plan::measure(*s.model, s.found.plan));
          },
          "Of the plan: 'nodes', 'branches', 'leaves', 'longest_path', 'cost', 'actions_in_tree'; "
          "or "
          "None.")
      .def_property_readonly(
          "failed_calls",
          [](const SolutionValue& s) {
            py::list out;
            for (const plan::FailedCalls::Failure& f : s.failures) {
              py::dict one;
              one["call"] = f.call;
              one["reason"] = f.reason;
              one["times"] = f.times;
              one["impossible"] = f.impossible;
              out.append(one);
            }
            return out;
          },
          "Dicts of calls of external functions that returned no value, the most frequent first: "
          "'call', 'reason', 'times' and 'impossible' (else not found).")
      .def(
          "write",
          [](const SolutionValue& s, const py::object& path) {
            const std::string file = required_path(path, "path");
            if (!s.solved()) throw Error(ErrorCode::InvalidArgument, "the solution has no plan");
            run(0, [&] { io::write_file(file, plan::write_plan(*s.model, s.found.plan)); });
          },
          py::arg("path"), "Writes the plan (JSON), the bytes of `kaboum-plan solve`.")
      .def_property_readonly("statistics", &statistics_of, "Counters, as in kaboum-plan's report.")
      .def_property_readonly("notes", notes_of(&SolutionValue::notes),
                             "What a user should know of the scene.")
      .def("__bool__", &SolutionValue::solved)
      .def("__repr__", [](const SolutionValue& s) {
        return std::string("<kaboum.Solution: ") + (s.solved() ? "solved" : "no plan") + ">";
      });
}

SolutionValue solve(const py::object& domain, const py::object& problem, const py::object& scene,
                    const py::object& assume, const py::kwargs& given) {
  py::dict keywords = given;
  execution::TaskFiles files = files_of(domain, problem, scene, keywords, true);
  plan::SearchRequest options;
  take_options(plan::solve_options(), keywords, options);
  const RunKeywords running = take_run_keywords(keywords);
  require_all_taken("solve", keywords, solve_keywords());
  files.answers_kept = !running.no_cache;
  options.assumed = outcomes_of(assume, "assume");
  Watch watch(running.progress);
  options.progress = [&watch](const plan::Statistics& s) {
    watch(std::to_string(s.expanded) + " states expanded, depth " + std::to_string(s.depth));
  };
  return run(running.threads, [&] {
    SolutionValue out;
    const execution::PlanningTask task(files);
    if (task.scene() != nullptr) out.notes = task.scene()->notes;
    out.model = std::make_shared<plan::Model>(task.load());
    out.found = plan::solve(*out.model, options);
    out.failures = task.failures();
    task.keep_answers();
    return out;
  });
}

/// A plan as it was given: its JSON, and what it is called in messages.
struct PlanText {
  std::string text, name = "plan";

  /// @param plan  a dict, a Solution's or as JSON reads it; a Solution; or the name of a file.
  explicit PlanText(const py::object& plan) {
    if (py::isinstance<SolutionValue>(plan)) {
      const auto& solution = plan.cast<const SolutionValue&>();
      if (!solution.solved()) throw Error(ErrorCode::InvalidArgument, "the solution has no plan");
      text = plan::write_plan(*solution.model, solution.found.plan);
    } else if (const auto path = path_of(plan)) {
      name = *path;
      text = text_of_file(*path);
    } else {
      text = json_text(plan);
    }
  }
  [[nodiscard]] plan::Plan read(const plan::Model& model) const {
    return plan::read_plan(model, text, name);
  }
};

struct CheckValue {
  plan::CheckResult result;
  plan::PlanSize size;
};

CheckValue check_plan(const py::object& domain, const py::object& problem, const py::object& plan,
                      const py::object& scene, const py::kwargs& given_keywords) {
  py::dict keywords = given_keywords;
  const execution::TaskFiles files = files_of(domain, problem, scene, keywords, true);
  const RunKeywords running = take_run_keywords(keywords, Runs::Threads);
  require_all_taken("check_plan", keywords, check_keywords(), Runs::Threads);
  const PlanText given(plan);
  Watch watch(running.progress);
  return run(running.threads, [&] {
    const execution::PlanningTask task(files);
    const plan::Model model = task.load();
    const plan::Plan read = given.read(model);
    CheckValue out;
    out.size = plan::measure(model, read);
    out.result = plan::check(model, read, plan::kMostStates, [&](std::uint64_t states) {
      watch(std::to_string(states) + " states replayed");
    });
    return out;
  });
}

std::string draw_plan(const py::object& domain, const py::object& problem, const py::object& plan,
                      const std::string& format, bool tree, const py::object& scene,
                      const py::kwargs& given_keywords) {
  py::dict keywords = given_keywords;
  const execution::TaskFiles files = files_of(domain, problem, scene, keywords);
  const RunKeywords running = take_run_keywords(keywords, Runs::Alone);
  require_all_taken("draw_plan", keywords, task_keywords(), Runs::Alone);
  const PlanText given(plan);
  const Drawing draw = value_of(kDrawings, format, "format");
  Watch watch(running.progress);
  const plan::PlanProgress drawing = [&] { watch("drawing the plan"); };
  return run(0, [&] {
    watch("reading the plan");
    const execution::PlanningTask task(files);
    const plan::Model model = task.load();
    plan::Plan read = given.read(model);
    if (tree) read = plan::expand_tree(read, plan::kMostTreeNodes, drawing);
    return draw(model, read, drawing);
  });
}

std::vector<std::string> write_plan_page(const py::object& file, const py::object& domain,
                                         const py::object& problem, const py::object& plan,
                                         const py::object& scene, bool tree,
                                         const py::kwargs& given_keywords) {
  py::dict keywords = given_keywords;
  const std::string path = required_path(file, "file");
  const execution::TaskFiles files = files_of(domain, problem, scene, keywords);
  execution::PlanPageOptions options{.tree = tree};
  take_options(execution::page_options(), keywords, options);
  const RunKeywords running = take_run_keywords(keywords, Runs::Alone);
  require_all_taken("write_plan_page", keywords, page_keywords(), Runs::Alone);
  const PlanText given(plan);
  Watch watch(running.progress);
  options.progress = watch.hook();
  return run(0, [&] {
    watch("reading the plan");
    const execution::PlanningTask task(files);
    if (task.scene() == nullptr)
      throw Error(ErrorCode::InvalidArgument, "scene is needed: what is there to be seen");
    const plan::Model model = task.load();
    const execution::PlanPage page = execution::plan_page(task, model, given.read(model), options);
    io::write_file(path, page.html);
    std::vector<std::string> notes = task.scene()->notes;
    notes.insert(notes.end(), page.notes.begin(), page.notes.end());
    return spelled(std::move(notes));
  });
}

std::vector<std::string> write_run_page(const py::object& file, const py::object& journal,
                                        const py::object& scene, const py::kwargs& given_keywords) {
  py::dict keywords = given_keywords;
  const std::string path = required_path(file, "file"), lines = required_path(journal, "journal"),
                    scene_file = required_path(scene, "scene");
  execution::PlanPageOptions options;
  take_options(execution::page_options(), keywords, options);
  const RunKeywords running = take_run_keywords(keywords, Runs::Alone);
  require_all_taken("write_run_page", keywords, keywords_of(execution::page_options()),
                    Runs::Alone);
  Watch watch(running.progress);
  return run(0, [&] {
    watch("reading the scene");
    const world::SceneFile read = world::read_scene(scene_file);
    watch("reading the journal");
    const std::vector<std::string> entries = execution::journal_lines(lines);
    watch("drawing");
    const execution::PlanPage page =
        execution::run_page(read.world, scene_file, entries, options.packages);
    io::write_file(path, page.html);
    std::vector<std::string> notes = read.notes;
    notes.insert(notes.end(), page.notes.begin(), page.notes.end());
    return spelled(std::move(notes));
  });
}

/// 'all'; a whole number: at random; or what outcomes_of takes.
plan::RunOptions run_options(const py::object& outcomes) {
  plan::RunOptions out;
  if (py::isinstance<py::str>(outcomes) && outcomes.cast<std::string>() == "all") return out;
  if (py::isinstance<py::int_>(outcomes) && !py::isinstance<py::bool_>(outcomes)) {
    out.outcomes = plan::RunOptions::Outcomes::Random;
    out.seed = outcomes.cast<std::uint64_t>();
    return out;
  }
  if (outcomes.is_none())
    throw Error(ErrorCode::InvalidArgument, "outcomes must be 'all', a seed, a dict or a file");
  out.outcomes = plan::RunOptions::Outcomes::Given;
  out.given = outcomes_of(outcomes, "outcomes");
  return out;
}

execution::PlanRunReport run_plan(const py::object& domain, const py::object& problem,
                                  const py::object& plan, const py::object& scene,
                                  const py::object& outcomes, const py::object& trajectories,
                                  const py::kwargs& given_keywords) {
  py::dict keywords = given_keywords;
  const execution::TaskFiles files = files_of(domain, problem, scene, keywords);
  execution::PlanRunRequest request;
  take_options(execution::run_options(), keywords, request);
  const RunKeywords running = take_run_keywords(keywords, Runs::Threads);
  require_all_taken("run_plan", keywords, run_keywords(), Runs::Threads);
  const PlanText given(plan);
  request.replan.run = run_options(outcomes);
  request.replan.solve.algorithm = plan::Algorithm::Greedy;
  if (!trajectories.is_none()) request.trajectories = required_path(trajectories, "trajectories");
  Watch watch(running.progress);
  request.simulation.progress = watch.hook();
  return run(running.threads, [&] {
    const execution::PlanningTask task(files);
    if (task.scene() == nullptr)
      throw Error(ErrorCode::InvalidArgument, "scene is needed: a plan is carried out in it");
    const plan::Model model = task.load();
    execution::PlanRunReport out = execution::run_plan(task, model, given.read(model), request);
    const std::vector<std::string>& notes = task.scene()->notes;
    out.notes.insert(out.notes.begin(), notes.begin(), notes.end());
    return out;
  });
}

py::dict counts_of(const execution::PlanRunReport& r) {
  const execution::SimulationReport& s = r.simulation;
  py::dict out;
  out["branches"] = r.plans.run.branches;
  out["ends"] = r.plans.run.ends;
  out["states"] = r.plans.run.states;
  out["steps"] = s.steps;
  out["motions"] = s.motions;
  out["samples"] = s.samples;
  out["motion_s"] = s.seconds;
  out["collisions"] = s.collisions;
  out["limit_violations"] = s.limit_violations;
  out["jumps"] = s.jumps;
  out["most_velocity"] = s.most_velocity;
  out["most_acceleration"] = s.most_acceleration;
  out["most_jerk"] = s.most_jerk;
  out["blends"] = s.blends;
  out["triangles"] = r.triangles;
  return out;
}

py::list replans_of(const execution::PlanRunReport& r) {
  py::list out;
  for (const plan::Replan& replan : r.plans.replans) {
    py::dict one;
    one["outcome"] = replan.outcome;
    one["actions_before"] = replan.actions;
    one["after_plan"] = replan.after;
    one["status"] = plan::name_of(replan.result);
    one["reason"] = replan.reason;
    one["nodes"] = replan.nodes;
    one["known_before"] = replan.reached;
    one["circle"] = replan.circle;
    one["wall_seconds"] = replan.seconds;
    out.append(one);
  }
  return out;
}

std::string convert_domain(const py::object& domain, const py::object& problem,
                           const std::string& to, const std::optional<std::string>& input_format,
                           const std::optional<std::string>& problem_format,
                           const py::object& progress) {
  py::dict keywords;
  keywords["input_format"] = input_format;
  keywords["problem_format"] = problem_format;
  const execution::TaskFiles files = files_of(domain, problem, py::none(), keywords);
  const plan::Language language = value_of(kLanguages, to, "to");
  Watch watch(progress);
  return run(0, [&] {
    watch("reading the domain");
    const plan::TaskTexts texts = execution::read_texts(files);
    watch("converting the domain");
    return plan::convert(texts.domain, texts.problem ? &*texts.problem : nullptr, language);
  });
}

void bind_results(py::module_& module) {
  py::class_<CheckValue>(module, "PlanCheck",
                         "Whether a plan is valid: true if and only if every end meets the goal.")
      .def("__bool__", [](const CheckValue& c) { return c.result.valid; })
      .def_property_readonly(
          "violation", [](const CheckValue& c) { return c.result.violation; },
          "What fails first, with the actions and outcomes that lead there; '': nothing.")
      .def_property_readonly(
          "states", [](const CheckValue& c) { return c.result.states; },
          "Pairs of a node and a state of knowledge that were replayed.")
      .def_property_readonly(
          "ends", [](const CheckValue& c) { return c.result.leaves; },
          "Distinct ones of these at an end of the plan.")
      .def_property_readonly(
          "size", [](const CheckValue& c) { return dict_of(c.size); }, "As of `Solution`.")
      .def("__repr__", [](const CheckValue& c) {
        return std::string("<kaboum.PlanCheck: ") +
               (c.result.valid ? "valid" : c.result.violation) + ">";
      });
  py::class_<execution::PlanRunReport>(
      module, "PlanRun",
      "What came of carrying a plan out: true if every way came to its end, and no sample on it "
      "was "
      "in contact, beyond a limit, or elsewhere than the plan says.")
      .def("__bool__", &execution::PlanRunReport::good)
      .def_property_readonly(
          "counts", &counts_of,
          "What was looked at, and what was wrong: 'branches', 'motions', "
          "'samples', 'collisions', 'limit_violations', 'jumps', and so on, as in "
          "kaboum-plan's report.")
      .def_property_readonly(
          "replans", &replans_of,
          "Dicts of plans that were made on the way: 'outcome' (that the plan had "
          "no branch for), 'status', 'reason', 'nodes', and so on.")
      .def_property_readonly(
          "problems", [](const execution::PlanRunReport& r) { return r.simulation.problems; },
          "What was wrong, in words; the first twenty.")
      .def_property_readonly("notes", notes_of(&execution::PlanRunReport::notes),
                             "What a user should know of the scene.")
      .def("__repr__", [](const execution::PlanRunReport& r) {
        return std::string("<kaboum.PlanRun: ") + (r.good() ? "good" : "not good") + ">";
      });
}

constexpr const char* kSolveDoc =
    R"(Finds a plan, under incomplete knowledge and with sensing, as `kaboum-plan solve`.

Parameters
----------
domain, problem : path
    .kpl or .pddl; the domain's file may hold the problem.
scene : path, optional
    Whose geometry answers external functions (docs/planning/geometry.md).
assume : dict or path, optional
    Outcomes of sensing that the plan needs branches for alone, {'isSpillable(o1)': False}, or a
    file of them.
{keywords}

Raises
------
Error
    'invalid_input' naming line and column.)";

constexpr const char* kCheckDoc =
    R"(Replays every branch of a plan, independently of the planner, as `kaboum-plan check`.

Parameters
----------
domain, problem, scene
    As for `solve`.
plan : Solution, dict or path
{keywords}

Returns
-------
PlanCheck
    True if and only if it is valid; `violation` is what fails first.

Raises
------
Error
    'invalid_input' when it is no plan of this domain.)";

constexpr const char* kRunDoc =
    R"(Carries out a plan in simulation, and judges every sample by exact meshes, as `kaboum-plan run`.

Parameters
----------
domain, problem, plan
    As for `check_plan`.
scene : path
outcomes : str, int, dict or path
    How sensing turns out: 'all': every branch; a number: one run, at random, of this seed; a dict,
    {'isSpillable(o1)': True}, or a file of it: as it says.
trajectories : path, optional
    A folder that each motion's samples are written into, and what happens between motions:
    plan.json and events.csv (docs/planning/trajectories.md).
{keywords}

Returns
-------
PlanRun)";

constexpr const char* kDrawDoc =
    R"(A plan as an indented text, Graphviz DOT or SVG, as `kaboum-plan show`.

Parameters
----------
domain, problem, plan, scene
    As for `check_plan`.
format : str
    'text', 'dot' or 'svg'.
tree : bool
    Expand shared sub-plans.
{keywords}

Returns
-------
str)";

constexpr const char* kPageDoc =
    R"(Writes a page that plays a plan in its scene, every branch of it, as `kaboum-plan show --html`.

Parameters
----------
file : path
    One HTML file, which needs nothing besides itself (docs/pages.md).
domain, problem, plan
    As for `check_plan`.
scene : path
tree : bool
    Expand shared sub-plans.
{keywords}

Returns
-------
list of str
    What a user should know of scene and page.)";

constexpr const char* kRunPageDoc =
    R"(Writes a page that shows a run by a robot, from its journal, as `kaboum-plan page`.

Parameters
----------
file : path
    One HTML file, which needs nothing besides itself (docs/pages.md#runs).
journal : path
    What `kaboum-plan run --journal` wrote.
scene : path
    The scene of the run.
{keywords}

Returns
-------
list of str
    What a user should know of scene and page.

Raises
------
Error
    'invalid_input' for a file that is no journal, naming the line.)";

constexpr const char* kConvertDoc =
    R"(A domain, with its problem if there is one, in another language, as `kaboum-plan convert`.

Parameters
----------
domain, problem, input_format, problem_format
    As for `solve`.
to : str
    'kpl' or 'pddl'.
progress
    As of `solve`.

Returns
-------
str

Raises
------
Error
    'invalid_input' naming what cannot be said in it.)";

/// Functions whose options stand in tables.
void bind_functions_with_options(py::module_& module) {
  py::options signatures;
  signatures.disable_function_signatures();  // the tables'
  const std::string of_plan = "domain: object, problem: object, plan: object, *, ";
  const std::string solving = document(
      "solve",
      "domain: object, problem: object = None, *, scene: object = None, assume: object = None",
      solve_keywords(), "kaboum.Solution", kSolveDoc);
  module.def("solve", &solve, py::arg("domain"), py::arg("problem") = py::none(), py::kw_only(),
             py::arg("scene") = py::none(), py::arg("assume") = py::none(), solving.c_str());
  const std::string checking =
      document("check_plan", of_plan + "scene: object = None", check_keywords(), "kaboum.PlanCheck",
               kCheckDoc, Runs::Threads);
  module.def("check_plan", &check_plan, py::arg("domain"), py::arg("problem"), py::arg("plan"),
             py::kw_only(), py::arg("scene") = py::none(), checking.c_str());
  const std::string drawing = document(
      "draw_plan", of_plan + "format: str = 'svg', tree: bool = False, scene: object = None",
      task_keywords(), "str", kDrawDoc, Runs::Alone);
  module.def("draw_plan", &draw_plan, py::arg("domain"), py::arg("problem"), py::arg("plan"),
             py::kw_only(), py::arg("format") = "svg", py::arg("tree") = false,
             py::arg("scene") = py::none(), drawing.c_str());
  const std::string paging =
      document("write_plan_page", "file: object, " + of_plan + "scene: object, tree: bool = False",
               page_keywords(), "list[str]", kPageDoc, Runs::Alone);
  module.def("write_plan_page", &write_plan_page, py::arg("file"), py::arg("domain"),
             py::arg("problem"), py::arg("plan"), py::kw_only(), py::arg("scene"),
             py::arg("tree") = false, paging.c_str());
  const std::string run_paging =
      document("write_run_page", "file: object, journal: object, *, scene: object",
               keywords_of(execution::page_options()), "list[str]", kRunPageDoc, Runs::Alone);
  module.def("write_run_page", &write_run_page, py::arg("file"), py::arg("journal"), py::kw_only(),
             py::arg("scene"), run_paging.c_str());
  const std::string carrying = document(
      "run_plan", of_plan + "scene: object, outcomes: object = 'all', trajectories: object = None",
      run_keywords(), "kaboum.PlanRun", kRunDoc, Runs::Threads);
  module.def("run_plan", &run_plan, py::arg("domain"), py::arg("problem"), py::arg("plan"),
             py::kw_only(), py::arg("scene"), py::arg("outcomes") = "all",
             py::arg("trajectories") = py::none(), carrying.c_str());
}

}  // namespace

void bind_planning(py::module_& module) {
  bind_planning_class(module);
  bind_results(module);
  module.def("convert_domain", &convert_domain, py::arg("domain"), py::arg("problem") = py::none(),
             py::kw_only(), py::arg("to"), py::arg("input_format") = py::none(),
             py::arg("problem_format") = py::none(), py::arg("progress") = py::none(), kConvertDoc);
  bind_functions_with_options(module);
}

}  // namespace kaboum::python
