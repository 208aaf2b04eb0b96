// The options of planning tasks and of carrying out plans: their tables.

#include <kaboum/engines/engine_options.h>
#include <kaboum/execution/task_options.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/robot/shape_options.h>

#include <array>
#include <utility>

namespace kaboum::execution {

const std::vector<Option<TaskFiles>>& task_options() {
  using R = TaskFiles;
  using plan::Language;
  static constexpr std::array<std::pair<const char*, Language>, 2> kLanguages{
      {{"kpl", Language::Kpl}, {"pddl", Language::Pddl}}};
  static const std::vector<Option<R>> options{
      choice<R>(
          {.name = "input-format",
           .text = "Language of the domain, and of the problem",
           .otherwise = "by extension"},
          [](auto& r) -> auto& { return r.language; }, kLanguages),
      choice<R>(
          {.name = "problem-format",
           .text = "Language of the problem",
           .otherwise = "as {input-format}, else by extension"},
          [](auto& r) -> auto& { return r.problem_language; }, kLanguages),
      option<R>(
          {.name = "process",
           .text = "A command whose program answers external functions by JSON lines "
                   "(docs/planning/externals.md); there may be several",
           .values = "COMMAND",
           .plural = "processes"},
          [](auto& r) -> auto& { return r.processes; }),
      option<R>(
          {.name = "process-timeout",
           .text = "Longest time for one answer of a program or plug-in, and for its start",
           .values = "SECONDS",
           .low = 1e-3,
           .high = 1e6},
          [](auto& r) -> auto& { return r.most_seconds; }),
      option<R>(
          {.name = "plugin",
           .text = "A shared library with external functions; there may be several",
           .plural = "plugins"},
          [](auto& r) -> auto& { return r.plugins; })};
  return options;
}

const std::vector<Option<TaskFiles>>& task_margin_options() {
  static const std::vector<Option<TaskFiles>> options = options_of_part<TaskFiles>(
      world::margin_options(), [](auto& r) -> auto& { return r.margin; });
  return options;
}

const std::vector<Option<TaskFiles>>& task_engine_options() {
  static const std::vector<Option<TaskFiles>> options = options_of_part<TaskFiles>(
      engines::engine_options(), [](auto& r) -> auto& { return r.engine; });
  return options;
}

const std::vector<Option<PlanRunRequest>>& run_options() {
  using R = PlanRunRequest;
  static const std::vector<Option<R>> options = [] {
    std::vector<Option<R>> made{
        option<R>(
            {.name = "replan",
             .text = "How often it is planned again, at most, where sensing turns out as the plan "
                     "has no branch for; 0: that is an error",
             .low = 0},
            [](auto& r) -> auto& { return r.replan.most; }),
        limit_option<R>(
            {.name = "timeout",
             .text = "Longest time for each new plan",
             .values = "SECONDS",
             .low = 0,
             .between = true,
             .otherwise = "no limit"},
            [](auto& r) -> auto& { return r.replan.solve.timeout; }),
        option<R>(
            {.name = "seed", .text = "Seed of new plans' external functions that choose at random"},
            [](auto& r) -> auto& { return r.replan.solve.seed; })};
    for (Option<R>& each : options_of_part<R>(
             motion::trajectory_options(), [](auto& r) -> auto& { return r.simulation.motion; }))
      made.push_back(std::move(each));
    static constexpr std::array<std::pair<const char*, MotionFormat>, 3> kFormats{
        {{"csv", MotionFormat::Csv}, {"json", MotionFormat::Json}, {"yaml", MotionFormat::Yaml}}};
    made.push_back(choice<R>(
        {.name = "trajectory-format",
         .text = "Of the files of motions that are written; json and yaml: a "
                 "trajectory_msgs/JointTrajectory of ROS 2"},
        [](auto& r) -> auto& { return r.motion_format; }, kFormats));
    made.push_back(option<R>(
        option_named(robot::shape_options(), "package-path"),
        [](auto& r) -> auto& { return r.packages; }));
    return made;
  }();
  return options;
}

const std::vector<Option<DriverOptions>>& driver_options() {
  using R = DriverOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "robot",
           .text = "A command whose program moves the robots and senses, told by JSON lines "
                   "(docs/planning/drivers.md)",
           .values = "COMMAND"},
          [](auto& r) -> auto& { return r.command; }),
      option<R>(
          {.name = "journal",
           .text = "Write every message to and from the robot's program into this file",
           .values = "FILE"},
          [](auto& r) -> auto& { return r.journal; }),
      option<R>(
          {.name = "replay-journal",
           .text = "Repeat the run of a journal instead of moving a robot: what it was told has to "
                   "be the same",
           .values = "FILE"},
          [](auto& r) -> auto& { return r.replayed; }),
      option<R>(
          {.name = "robot-timeout",
           .text =
               "Longest time for an answer of the robot's program, beside 1.5 times that of the "
               "motion",
           .values = "SECONDS",
           .low = 1e-3,
           .high = 1e6},
          [](auto& r) -> auto& { return r.most_seconds; }),
      option<R>(
          {.name = "robot-rate",
           .text = "Points per second of the trajectories that the robot's program is told",
           .values = "HZ",
           .low = 1,
           .high = 1e5},
          [](auto& r) -> auto& { return r.rate; }),
      option<R>(
          {.name = "robot-tracking",
           .text = "How far a joint may be from where it was told to be; beyond, all stops",
           .low = 1e-9,
           .high = 1e3},
          [](auto& r) -> auto& { return r.tracking; }),
      option<R>(
          {.name = "robot-retries",
           .text = "How often the robot's program is told again what has failed and changed "
                   "nothing",
           .low = 0,
           .high = 1000},
          [](auto& r) -> auto& { return r.retries; })};
  return options;
}

const std::vector<Option<PlanPageOptions>>& page_options() {
  static const std::vector<Option<PlanPageOptions>> options{option<PlanPageOptions>(
      option_named(robot::shape_options(), "package-path"),
      [](auto& r) -> auto& { return r.packages; })};
  return options;
}

}  // namespace kaboum::execution
