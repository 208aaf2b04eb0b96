#pragma once

#include <kaboum/engines/engine_world.h>
#include <kaboum/manipulation/answer_cache.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/plan/failed_calls.h>
#include <kaboum/plan/replan.h>
#include <kaboum/world/margins.h>
#include <kaboum/world/scene.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::execution {

/// A domain and a problem as files, and what answers their external functions.
struct TaskFiles {
  std::string domain, problem, scene;  ///< the last two may be empty; "-" is standard input
  /// None: by the files' names; of the problem: that of the domain, if that is given.
  std::optional<plan::Language> language = {}, problem_language = {};
  std::vector<std::string> plugins = {}, processes = {};  ///< with functions of a user's own
  double most_seconds = 10;                               ///< for an answer of these. > 0 [s]
  world::MarginRequest margin = {};                       ///< that is kept in the scene
  /// Who decides contacts in the scene. Of a library of others nothing is certified.
  engines::EngineRequest engine = {};
  /// Answers of the scene's functions are taken from the cache: never those of other libraries.
  bool answers_kept = false;
};

/// A planning task that was read from files, with the external functions of a scene, of programs
/// and of shared libraries.
class PlanningTask {
 public:
  /// @throws Error of files that cannot be read; Error{InvalidArgument} where a language is neither
  ///   given nor told by a name; as world::read_scene, external::start_process and load_plugin.
  explicit PlanningTask(const TaskFiles& files);
  ~PlanningTask();
  PlanningTask(PlanningTask&&) noexcept;
  PlanningTask& operator=(PlanningTask&&) = delete;

  [[nodiscard]] const TaskFiles& files() const;
  [[nodiscard]] const plan::TaskTexts& texts() const;
  /// nullptr: there is none.
  [[nodiscard]] const world::SceneFile* scene() const;
  /// @throws Error as plan::load.
  [[nodiscard]] plan::Model load() const;

  /// Counters of the scene's functions, of all calls so far.
  [[nodiscard]] const manipulation::GeometryCounters& counters() const;
  [[nodiscard]] std::vector<plan::FailedCalls::Failure> failures() const;
  [[nodiscard]] std::size_t answers_reused() const;
  /// Keeps in the cache what came to it, for the next task; nothing without `answers_kept`.
  void keep_answers() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// A domain and a problem, without what answers external functions.
/// @throws Error as PlanningTask.
plan::TaskTexts read_texts(const TaskFiles& files);

}  // namespace kaboum::execution
