// Planning: kaboum.solve and check_plan, as kaboum-plan.

#include <kaboum/io/mesh_io.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>
#include <kaboum/world/scene.h>

#include "arguments.h"
#include "running.h"

namespace kaboum::python {
namespace {

constexpr std::array<std::pair<const char*, plan::Algorithm>, 5> kSearches{
    {{"dfs", plan::Algorithm::DepthFirst},
     {"bfs", plan::Algorithm::BreadthFirst},
     {"ids", plan::Algorithm::IterativeDeepening},
     {"greedy", plan::Algorithm::Greedy},
     {"astar", plan::Algorithm::AStar}}};
constexpr std::array<std::pair<const char*, plan::Outcome>, 4> kOutcomes{
    {{"solved", plan::Outcome::Solved},
     {"unsolvable", plan::Outcome::Unsolvable},
     {"not inferred", plan::Outcome::NotInferred},
     {"limit", plan::Outcome::Limit}}};

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

plan::Text text_of(const std::string& path) {
  const auto language = plan::language_from_name(path);
  if (!language)
    throw Error(ErrorCode::InvalidArgument,
                path +
                    ": cannot tell the language from the name, which ends with .kpl, .pddl or "
                    ".xml");
  return {path, text_of_file(path), *language};
}

world::World world_of(const std::string& path, std::vector<std::string>& notes) {
  world::SceneFile scene = world::read_scene(path);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  return std::move(scene.world);
}

/// A domain and a problem, bound to a scene where one is given.
struct Problem {
  std::string domain, problem, scene;  ///< files; the last two may be empty

  Problem(const py::object& domain_file, const py::object& problem_file,
          const py::object& scene_file)
      : domain(required_path(domain_file, "domain")) {
    if (!problem_file.is_none()) problem = required_path(problem_file, "problem");
    if (!scene_file.is_none()) scene = required_path(scene_file, "scene");
  }

  [[nodiscard]] plan::Model load(std::vector<std::string>& notes) const {
    plan::ExternalBindings bindings;
    if (!scene.empty()) bindings = manipulation::bind_externals(world_of(scene, notes), {});
    const plan::Text first = text_of(domain);
    if (problem.empty()) return plan::load(first, nullptr, bindings);
    const plan::Text second = text_of(problem);
    return plan::load(first, &second, bindings);
  }
};

struct SolutionValue {
  std::shared_ptr<const plan::Model> model;
  plan::Solution found;
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
          "outcome",
          [](const SolutionValue& s) {
            for (const auto& [name, outcome] : kOutcomes)
              if (outcome == s.found.outcome) return name;
            return "";
          },
          "'solved'; 'unsolvable', which is proved; 'not inferred': all was tried, but the "
          "knowledge "
          "state keeps less than could be concluded; 'limit'.")
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
      .def_property_readonly("statistics", &statistics_of, "Counters, as in kaboum-plan's report.")
      .def_readonly("notes", &SolutionValue::notes, "What a user should know of the scene.")
      .def("__bool__", &SolutionValue::solved)
      .def("__repr__", [](const SolutionValue& s) {
        return std::string("<kaboum.Solution: ") + (s.solved() ? "solved" : "no plan") + ">";
      });
}

SolutionValue solve(const py::object& domain, const py::object& problem, const py::object& scene,
                    const std::string& search, const std::optional<double>& timeout,
                    const std::optional<std::size_t>& max_memory, std::uint64_t seed, int threads,
                    const py::object& progress) {
  const Problem files(domain, problem, scene);
  plan::SolveOptions options;
  options.algorithm = value_of(kSearches, search, "search");
  if (timeout && !(*timeout > 0))
    throw Error(ErrorCode::InvalidArgument, "timeout must be a number of seconds above 0");
  options.timeout = timeout.value_or(0);
  options.max_memory = max_memory.value_or(0);
  options.seed = seed;
  Watch watch(progress);
  options.progress = [&watch](const plan::Statistics& s) {
    watch(std::to_string(s.expanded) + " states expanded, depth " + std::to_string(s.depth));
  };
  return run(threads, [&] {
    SolutionValue out;
    out.model = std::make_shared<plan::Model>(files.load(out.notes));
    out.found = plan::solve(*out.model, options);
    return out;
  });
}

/// @param plan  a dict, a Solution's or as JSON reads it; a Solution; or the name of a file.
py::tuple check_plan(const py::object& domain, const py::object& problem, const py::object& plan,
                     const py::object& scene) {
  const Problem files(domain, problem, scene);
  std::string text, name = "plan";
  if (py::isinstance<SolutionValue>(plan)) {
    const auto& solution = plan.cast<const SolutionValue&>();
    if (!solution.solved()) throw Error(ErrorCode::InvalidArgument, "the solution has no plan");
    text = plan::write_plan(*solution.model, solution.found.plan);
  } else if (const auto path = path_of(plan)) {
    name = *path;
    text = text_of_file(*path);
  } else {
    text = py::module_::import("json").attr("dumps")(plan).cast<std::string>();
  }
  const plan::CheckResult found = run(0, [&] {
    std::vector<std::string> notes;
    const plan::Model model = files.load(notes);
    return plan::check(model, plan::read_plan(model, text, name));
  });
  return py::make_tuple(found.valid, found.violation);
}

}  // namespace

void bind_planning(py::module_& module) {
  bind_class(module);
  module.def("solve", &solve, py::arg("domain"), py::arg("problem") = py::none(), py::kw_only(),
             py::arg("scene") = py::none(), py::arg("search") = "greedy",
             py::arg("timeout") = py::none(), py::arg("max_memory") = py::none(),
             py::arg("seed") = 1, py::arg("threads") = 0, py::arg("progress") = py::none(),
             R"(Finds a plan, under incomplete knowledge and with sensing, as `kaboum-plan solve`.

Parameters
----------
domain, problem : path
    .kpl, .pddl or .xml; the domain's file may hold the problem.
scene : path, optional
    Whose geometry answers external functions (docs/planning/geometry.md).
search : str
    'greedy', 'astar', 'bfs', 'ids' or 'dfs'.
timeout : float, optional
    [s]
max_memory : int, optional
    Of grounding and search. [bytes]
seed : int
    Of external functions that choose at random.
threads, progress
    As for `decimate`.

Raises
------
Error
    'invalid_input' naming line and column.)");
  module.def(
      "check_plan", &check_plan, py::arg("domain"), py::arg("problem"), py::arg("plan"),
      py::kw_only(), py::arg("scene") = py::none(),
      R"(Replays every branch of a plan, independently of the planner, as `kaboum-plan check`.

Parameters
----------
domain, problem, scene
    As for `solve`.
plan : Solution, dict or path

Returns
-------
(bool, str)
    Whether it is valid, and what fails first.

Raises
------
Error
    'invalid_input' when it is no plan of this domain.)");
}

}  // namespace kaboum::python
