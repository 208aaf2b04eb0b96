// Planning: kaboum.solve, check_plan, draw_plan, write_plan_page, run_plan and convert_domain, as
// kaboum-plan.

#include <kaboum/execution/plan_page.h>
#include <kaboum/execution/run_plan.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/outcomes.h>

#include <cstdio>
#include <map>

#include "arguments.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

constexpr std::array<std::pair<const char*, plan::Algorithm>, 5> kSearches{
    {{"dfs", plan::Algorithm::DepthFirst},
     {"bfs", plan::Algorithm::BreadthFirst},
     {"ids", plan::Algorithm::IterativeDeepening},
     {"greedy", plan::Algorithm::Greedy},
     {"astar", plan::Algorithm::AStar}}};
constexpr std::array<std::pair<const char*, plan::Language>, 2> kLanguages{
    {{"kpl", plan::Language::Kpl}, {"pddl", plan::Language::Pddl}}};
using Drawing = std::string (*)(const plan::Model&, const plan::Plan&, const plan::PlanProgress&);
constexpr std::array<std::pair<const char*, Drawing>, 3> kDrawings{
    {{"text", &plan::plan_text}, {"dot", &plan::plan_dot}, {"svg", &plan::plan_svg}}};

std::string required_path(const py::object& value, const char* argument) {
  const auto path = path_of(value);
  if (!path)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a str or an os.PathLike");
  return *path;
}

std::string text_of_file(const std::string& path) {
  const std::vector<char> bytes = io::read_file(path);
  return {bytes.begin(), bytes.end()};
}

std::string json_text(const py::handle& value) {
  return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

/// A sequence of paths or commands; one of them may stand alone.
std::vector<std::string> texts_of(const py::object& value, const char* argument) {
  if (const auto one = path_of(value)) return {*one};
  std::vector<std::string> out;
  if (!py::isinstance<py::sequence>(value))
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a str or a sequence of them");
  for (const py::handle item : value.cast<py::sequence>())
    out.push_back(required_path(py::reinterpret_borrow<py::object>(item), argument));
  return out;
}

/// What the functions have in common: a domain, a problem, and what answers external functions.
struct Source {
  py::object domain, problem, scene, plugins, processes;
  double process_timeout;
  std::optional<std::string> input_format, problem_format;

  [[nodiscard]] execution::TaskFiles files() const {
    execution::TaskFiles out;
    out.domain = required_path(domain, "domain");
    if (!problem.is_none()) out.problem = required_path(problem, "problem");
    if (!scene.is_none()) out.scene = required_path(scene, "scene");
    if (input_format) out.language = value_of(kLanguages, *input_format, "input_format");
    if (problem_format)
      out.problem_language = value_of(kLanguages, *problem_format, "problem_format");
    out.plugins = texts_of(plugins, "plugins");
    out.processes = texts_of(processes, "processes");
    if (!(process_timeout >= 1e-3 && process_timeout <= 1e6))
      throw Error(ErrorCode::InvalidArgument,
                  "process_timeout must be a number of seconds from 0.001 to 1e6");
    out.most_seconds = process_timeout;
    return out;
  }
};

/// A dict of outcomes, or a file of them.
std::map<std::string, std::string> outcomes_of(const py::object& value, const char* argument) {
  if (value.is_none()) return {};
  if (const auto path = path_of(value)) return plan::parse_outcomes(text_of_file(*path), *path);
  if (!py::isinstance<py::dict>(value))
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a dict of outcomes, or a file of them");
  return plan::parse_outcomes(json_text(value), argument);
}

double seconds_of(const std::optional<double>& timeout) {
  if (timeout && !(*timeout > 0))
    throw Error(ErrorCode::InvalidArgument, "timeout must be a number of seconds above 0");
  return timeout.value_or(0);
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

void bind_class(py::module_& module) {
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
      .def_readonly("notes", &SolutionValue::notes, "What a user should know of the scene.")
      .def("__bool__", &SolutionValue::solved)
      .def("__repr__", [](const SolutionValue& s) {
        return std::string("<kaboum.Solution: ") + (s.solved() ? "solved" : "no plan") + ">";
      });
}

SolutionValue solve(const Source& source, const std::string& search, const py::object& assume,
                    const std::optional<double>& timeout,
                    const std::optional<std::size_t>& max_memory, std::uint64_t seed, bool no_cache,
                    int threads, const py::object& progress) {
  execution::TaskFiles files = source.files();
  files.answers_kept = !no_cache;
  plan::SolveOptions options;
  options.algorithm = value_of(kSearches, search, "search");
  options.timeout = seconds_of(timeout);
  options.max_memory = max_memory.value_or(0);
  options.seed = seed;
  options.assumed = outcomes_of(assume, "assume");
  Watch watch(progress);
  options.progress = [&watch](const plan::Statistics& s) {
    watch(std::to_string(s.expanded) + " states expanded, depth " + std::to_string(s.depth));
  };
  return run(threads, [&] {
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

CheckValue check_plan(const Source& source, const py::object& plan, int threads,
                      const py::object& progress) {
  const execution::TaskFiles files = source.files();
  const PlanText given(plan);
  Watch watch(progress);
  return run(threads, [&] {
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

std::string draw_plan(const Source& source, const py::object& plan, const std::string& format,
                      bool tree, const py::object& progress) {
  const execution::TaskFiles files = source.files();
  const PlanText given(plan);
  const Drawing draw = value_of(kDrawings, format, "format");
  Watch watch(progress);
  const std::function<void()> drawing = [&] { watch("drawing the plan"); };
  return run(0, [&] {
    const execution::PlanningTask task(files);
    const plan::Model model = task.load();
    plan::Plan read = given.read(model);
    if (tree) read = plan::expand_tree(read, plan::kMostTreeNodes, drawing);
    return draw(model, read, drawing);
  });
}

std::vector<std::string> write_plan_page(const Source& source, const py::object& plan,
                                         const py::object& path, bool tree,
                                         const py::object& package_path, int threads,
                                         const py::object& progress) {
  const execution::TaskFiles files = source.files();
  if (files.scene.empty())
    throw Error(ErrorCode::InvalidArgument, "scene is needed: a page shows it");
  const std::string file = required_path(path, "path");
  const PlanText given(plan);
  Watch watch(progress);
  const execution::PlanPageOptions options{tree, packages_of(package_path), watch.hook()};
  return run(threads, [&] {
    const execution::PlanningTask task(files);
    const plan::Model model = task.load();
    execution::PlanPage page = execution::plan_page(task, model, given.read(model), options);
    io::write_file(file, page.html);
    std::vector<std::string> notes = task.scene()->notes;
    notes.insert(notes.end(), page.notes.begin(), page.notes.end());
    return notes;
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

struct Execution {
  py::object outcomes, trajectories, package_path;
  unsigned replan;
  double rate, max_acceleration;
  bool time_optimal;
  std::uint64_t seed;
};

void require_number(double value, double least, double most, const char* argument) {
  if (value >= least && value <= most) return;
  char text[96];
  std::snprintf(text, sizeof text, "%s must be a number from %g to %g", argument, least, most);
  throw Error(ErrorCode::InvalidArgument, text);
}

execution::PlanRunReport run_plan(const Source& source, const py::object& plan,
                                  const Execution& asked, const std::optional<double>& timeout,
                                  int threads, const py::object& progress) {
  const execution::TaskFiles files = source.files();
  if (files.scene.empty())
    throw Error(ErrorCode::InvalidArgument, "scene is needed: a plan is carried out in it");
  const PlanText given(plan);
  require_number(asked.rate, 1, 1e5, "rate");
  require_number(asked.max_acceleration, 1e-3, 1e6, "max_acceleration");
  execution::PlanRunRequest request;
  request.replan.run = run_options(asked.outcomes);
  request.replan.most = asked.replan;
  request.replan.solve.algorithm = plan::Algorithm::Greedy;
  request.replan.solve.seed = asked.seed;
  request.replan.solve.timeout = seconds_of(timeout);
  request.simulation.rate = asked.rate;
  request.simulation.acceleration = asked.max_acceleration;
  if (asked.time_optimal) request.simulation.profile = motion::Profile::Trapezoid;
  request.packages = packages_of(asked.package_path);
  if (!asked.trajectories.is_none())
    request.trajectories = required_path(asked.trajectories, "trajectories");
  Watch watch(progress);
  request.simulation.progress = watch.hook();
  return run(threads, [&] {
    const execution::PlanningTask task(files);
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
  const Source source{domain,      problem, py::none(),   py::tuple(),
                      py::tuple(), 10,      input_format, problem_format};
  const execution::TaskFiles files = source.files();
  const plan::Language language = value_of(kLanguages, to, "to");
  Watch watch(progress);
  return run(0, [&] {
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
      .def_readonly("notes", &execution::PlanRunReport::notes,
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
search : str
    'greedy', 'astar', 'bfs', 'ids' or 'dfs'.
assume : dict or path, optional
    Outcomes of sensing that the plan needs branches for alone, {'isSpillable(o1)': False}, or a
    file of them.
timeout : float, optional
    [s]
max_memory : int, optional
    Of grounding and search. [bytes]
seed : int
    Of external functions that choose at random.
plugins : path or sequence of path
    Shared libraries with external functions (docs/planning/externals.md).
processes : str or sequence of str
    Commands whose programs answer external functions.
process_timeout : float
    Longest time for one answer of these. [s]
input_format, problem_format : str, optional
    'kpl' or 'pddl', where names do not tell.
no_cache : bool
    Ask a scene's functions anew, and keep nothing for the next run.
threads, progress
    As for `decimate`.

Raises
------
Error
    'invalid_input' naming line and column.)";

constexpr const char* kCheckDoc =
    R"(Replays every branch of a plan, independently of the planner, as `kaboum-plan check`.

Parameters
----------
domain, problem, scene, plugins, processes, process_timeout, input_format, problem_format
    As for `solve`.
plan : Solution, dict or path
threads, progress
    As for `decimate`.

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
domain, problem, plan, plugins, processes, process_timeout, input_format, problem_format
    As for `check_plan`.
scene : path
outcomes : str, int, dict or path
    How sensing turns out: 'all': every branch; a number: one run, at random, of this seed; a dict,
    {'isSpillable(o1)': True}, or a file of it: as it says.
replan : int
    How often it is planned again, at most, where sensing turns out as the plan has no branch for; 0:
    that is an error.
timeout : float, optional
    For each new plan. [s]
seed : int
    Of new plans' external functions.
rate : float
    Samples per second.
max_acceleration : float
    Of all joints. [rad/s^2, length/s^2]
time_optimal : bool
    As fast as velocities and accelerations allow, which then jump, instead of by polynomials.
trajectories : path, optional
    A folder that each motion's samples are written into, as CSV.
package_path : path or sequence of path
threads, progress
    As for `decimate`.

Returns
-------
PlanRun)";

void bind_execution(py::module_& module) {
  module.def(
      "run_plan",
      [](const py::object& domain, const py::object& problem, const py::object& plan,
         const py::object& scene, const py::object& outcomes, unsigned replan,
         const std::optional<double>& timeout, std::uint64_t seed, double rate,
         double max_acceleration, bool time_optimal, const py::object& trajectories,
         const py::object& package_path, const py::object& plugins, const py::object& processes,
         double process_timeout, const std::optional<std::string>& input_format,
         const std::optional<std::string>& problem_format, int threads,
         const py::object& progress) {
        return run_plan({domain, problem, scene, plugins, processes, process_timeout, input_format,
                         problem_format},
                        plan,
                        {outcomes, trajectories, package_path, replan, rate, max_acceleration,
                         time_optimal, seed},
                        timeout, threads, progress);
      },
      py::arg("domain"), py::arg("problem"), py::arg("plan"), py::kw_only(), py::arg("scene"),
      py::arg("outcomes") = "all", py::arg("replan") = 100, py::arg("timeout") = py::none(),
      py::arg("seed") = 1, py::arg("rate") = 1000.0, py::arg("max_acceleration") = 5.0,
      py::arg("time_optimal") = false, py::arg("trajectories") = py::none(),
      py::arg("package_path") = py::tuple(), py::arg("plugins") = py::tuple(),
      py::arg("processes") = py::tuple(), py::arg("process_timeout") = 10.0,
      py::arg("input_format") = py::none(), py::arg("problem_format") = py::none(),
      py::arg("threads") = 0, py::arg("progress") = py::none(), kRunDoc);
  module.def(
      "draw_plan",
      [](const py::object& domain, const py::object& problem, const py::object& plan,
         const std::string& format, bool tree, const py::object& scene, const py::object& plugins,
         const py::object& processes, double process_timeout,
         const std::optional<std::string>& input_format,
         const std::optional<std::string>& problem_format, const py::object& progress) {
        return draw_plan({domain, problem, scene, plugins, processes, process_timeout, input_format,
                          problem_format},
                         plan, format, tree, progress);
      },
      py::arg("domain"), py::arg("problem"), py::arg("plan"), py::kw_only(),
      py::arg("format") = "svg", py::arg("tree") = false, py::arg("scene") = py::none(),
      py::arg("plugins") = py::tuple(), py::arg("processes") = py::tuple(),
      py::arg("process_timeout") = 10.0, py::arg("input_format") = py::none(),
      py::arg("problem_format") = py::none(), py::arg("progress") = py::none(),
      R"(A plan as an indented text, Graphviz DOT or SVG, as `kaboum-plan show`.

Parameters
----------
domain, problem, plan, scene, plugins, processes, process_timeout, input_format, problem_format
    As for `check_plan`.
format : str
    'text', 'dot' or 'svg'.
tree : bool
    Expand shared sub-plans.
progress
    As for `decimate`.

Returns
-------
str)");
  module.def(
      "write_plan_page",
      [](const py::object& domain, const py::object& problem, const py::object& plan,
         const py::object& path, const py::object& scene, bool tree, const py::object& package_path,
         const py::object& plugins, const py::object& processes, double process_timeout,
         const std::optional<std::string>& input_format,
         const std::optional<std::string>& problem_format, int threads,
         const py::object& progress) {
        return write_plan_page({domain, problem, scene, plugins, processes, process_timeout,
                                input_format, problem_format},
                               plan, path, tree, package_path, threads, progress);
      },
      py::arg("domain"), py::arg("problem"), py::arg("plan"), py::arg("path"), py::kw_only(),
      py::arg("scene"), py::arg("tree") = false, py::arg("package_path") = py::tuple(),
      py::arg("plugins") = py::tuple(), py::arg("processes") = py::tuple(),
      py::arg("process_timeout") = 10.0, py::arg("input_format") = py::none(),
      py::arg("problem_format") = py::none(), py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      R"(Writes a page that plays a plan in its scene, the bytes of `kaboum-plan show --html`.

It is one HTML file, which needs nothing besides itself (docs/pages.md).

Parameters
----------
domain, problem, plan, plugins, processes, process_timeout, input_format, problem_format
    As for `check_plan`.
path : str or path
    Of the page.
scene : path
tree : bool
    Expand shared sub-plans.
package_path : path or sequence of path
    Folders that package:// is looked up in.
threads, progress
    As for `decimate`.

Returns
-------
list of str
    What a user should know of the scene and of the page.)");
  module.def(
      "convert_domain", &convert_domain, py::arg("domain"), py::arg("problem") = py::none(),
      py::kw_only(), py::arg("to"), py::arg("input_format") = py::none(),
      py::arg("problem_format") = py::none(), py::arg("progress") = py::none(),
      R"(A domain, with its problem if there is one, in another language, as `kaboum-plan convert`.

Parameters
----------
domain, problem, input_format, problem_format
    As for `solve`.
to : str
    'kpl' or 'pddl'.
progress
    As for `decimate`.

Returns
-------
str

Raises
------
Error
    'invalid_input' naming what cannot be said in it.)");
}

}  // namespace

void bind_planning(py::module_& module) {
  bind_class(module);
  bind_results(module);
  module.def(
      "solve",
      [](const py::object& domain, const py::object& problem, const py::object& scene,
         const std::string& search, const py::object& assume, const std::optional<double>& timeout,
         const std::optional<std::size_t>& max_memory, std::uint64_t seed,
         const py::object& plugins, const py::object& processes, double process_timeout,
         const std::optional<std::string>& input_format,
         const std::optional<std::string>& problem_format, bool no_cache, int threads,
         const py::object& progress) {
        return solve({domain, problem, scene, plugins, processes, process_timeout, input_format,
                      problem_format},
                     search, assume, timeout, max_memory, seed, no_cache, threads, progress);
      },
      py::arg("domain"), py::arg("problem") = py::none(), py::kw_only(),
      py::arg("scene") = py::none(), py::arg("search") = "greedy", py::arg("assume") = py::none(),
      py::arg("timeout") = py::none(), py::arg("max_memory") = py::none(), py::arg("seed") = 1,
      py::arg("plugins") = py::tuple(), py::arg("processes") = py::tuple(),
      py::arg("process_timeout") = 10.0, py::arg("input_format") = py::none(),
      py::arg("problem_format") = py::none(), py::arg("no_cache") = false, py::arg("threads") = 0,
      py::arg("progress") = py::none(), kSolveDoc);
  module.def(
      "check_plan",
      [](const py::object& domain, const py::object& problem, const py::object& plan,
         const py::object& scene, const py::object& plugins, const py::object& processes,
         double process_timeout, const std::optional<std::string>& input_format,
         const std::optional<std::string>& problem_format, int threads,
         const py::object& progress) {
        return check_plan({domain, problem, scene, plugins, processes, process_timeout,
                           input_format, problem_format},
                          plan, threads, progress);
      },
      py::arg("domain"), py::arg("problem"), py::arg("plan"), py::kw_only(),
      py::arg("scene") = py::none(), py::arg("plugins") = py::tuple(),
      py::arg("processes") = py::tuple(), py::arg("process_timeout") = 10.0,
      py::arg("input_format") = py::none(), py::arg("problem_format") = py::none(),
      py::arg("threads") = 0, py::arg("progress") = py::none(), kCheckDoc);
  bind_execution(module);
}

}  // namespace kaboum::python
