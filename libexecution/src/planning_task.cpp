// Planning tasks read from files, and their external functions.

#include <kaboum/base/error.h>
#include <kaboum/certify/cache_folder.h>
#include <kaboum/execution/planning_task.h>
#include <kaboum/external/plugin.h>
#include <kaboum/external/process.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>

#include "manipulation_task.h"

namespace kaboum::execution {
namespace {

constexpr const char* kAnswers = "KABOUM-ANSWERS 9";

/// @param option  that states the language
plan::Text read_text(const std::string& file, const std::optional<plan::Language>& given,
                     const char* option) {
  const auto language = given ? given : plan::language_from_name(file);
  if (!language)
    throw Error(ErrorCode::InvalidArgument,
                file +
                    ": cannot tell the language from the name, which ends with .kpl or .pddl; "
                    "state it («" +
                    option + "»)");
  const std::vector<char> bytes = io::read_file(file);
  return {file == "-" ? "stdin" : file, std::string(bytes.begin(), bytes.end()), *language};
}

}  // namespace

struct PlanningTask::Data {
  TaskFiles files;
  plan::TaskTexts texts;
  std::optional<world::SceneFile> scene;
  std::shared_ptr<manipulation::GeometryCounters> counters =
      std::make_shared<manipulation::GeometryCounters>();
  plan::FailedCalls failed;
  std::unique_ptr<manipulation::AnswerCache> cache;  ///< of the scene's functions; may be none
  std::string key;                                   ///< where it is kept

  /// One entry for scene, domain and problem: all that answers depend on beside the questions.
  void open_cache() {
    std::string all = scene->sha256 + '\n' + texts.domain.text + '\n' + KABOUM_VERSION + '\n' +
                      record_of(world::margin_options(), files.margin) + '\n';
    if (texts.problem) all += texts.problem->text;
    key = io::sha256({all.data(), all.size()});
    std::string flaw;
    const certify::CacheFolder folder(certify::CacheFolder::default_folder());
    cache =
        std::make_unique<manipulation::AnswerCache>(folder.find(kAnswers, key, flaw).value_or(""));
  }
};

namespace {

/// True of the name of a file with a task of usual actions.
bool is_manipulation_task(const std::string& file) { return file.ends_with(".task"); }

/// The texts of a task of usual actions, and the scene that they are of.
struct ReadTask {
  plan::TaskTexts texts;
  std::optional<world::SceneFile> scene;
};

ReadTask read_manipulation_task(const TaskFiles& files) {
  if (!files.problem.empty())
    throw Error(ErrorCode::InvalidArgument,
                files.domain + ": a task of usual actions needs no problem beside it");
  const std::vector<char> bytes = io::read_file(files.domain);
  const ManipulationTask task({bytes.begin(), bytes.end()}, files.domain);
  std::string scene = files.scene;
  if (scene.empty() && !task.scene().empty())
    scene = (std::filesystem::path(files.domain).parent_path() / task.scene()).string();
  if (scene.empty())
    throw Error(ErrorCode::InvalidArgument,
                files.domain +
                    ": a task of usual actions needs a scene: «scene», or a line "
                    "'scene FILE' in it");
  ReadTask out;
  out.scene = world::read_scene(scene);
  task.add_mates(out.scene->world);
  using plan::Language;
  plan::Text problem{files.domain + ", as a problem", task.problem(out.scene->world),
                     Language::Kpl};
  out.texts.domain = {"manipulation.kpl", kManipulationDomain, Language::Kpl};
  out.texts.problem = std::move(problem);
  return out;
}

}  // namespace

plan::TaskTexts read_texts(const TaskFiles& files) {
  if (is_manipulation_task(files.domain)) return read_manipulation_task(files).texts;
  plan::TaskTexts out{read_text(files.domain, files.language, "input-format"), {}};
  if (!files.problem.empty())
    out.problem =
        read_text(files.problem, files.problem_language ? files.problem_language : files.language,
                  "problem-format");
  return out;
}

PlanningTask::PlanningTask(const TaskFiles& files) : data_(std::make_unique<Data>()) {
  Data& d = *data_;
  d.files = files;
  if (is_manipulation_task(files.domain)) {
    ReadTask task = read_manipulation_task(files);
    d.texts = std::move(task.texts);
    d.scene = std::move(task.scene);
    d.files.scene = d.scene->inputs.front();
  } else {
    d.texts = read_texts(files);
    if (!files.scene.empty()) d.scene = world::read_scene(files.scene);
  }
  plan::ExternalBindings bindings;
  if (!d.scene && !files.margin.margins.empty())
    throw Error(ErrorCode::InvalidArgument,
                "«margin»: there is no scene in which things could be kept apart");
  if (!d.scene && files.engine.library != engines::Library::Own)
    throw Error(ErrorCode::InvalidArgument,
                "«engine»: there is no scene whose contacts it decides");
  if (d.scene) {
    d.scene->world.margins = world::margins_of(d.scene->world, files.margin);
    manipulation::ExternalOptions options;
    options.counters = d.counters;
    options.substitute = engines::make_substitute(d.scene->world, d.files.scene, files.engine);
    bindings = manipulation::bind_externals(d.scene->world, options);
    // What is kept is certified: answers of another library neither go there nor come from there.
    if (files.answers_kept && options.substitute == nullptr) {
      d.open_cache();
      bindings = d.cache->wrap(bindings);
    }
  }
  const external::ProcessOptions limits{files.most_seconds};
  for (const std::string& file : files.plugins)
    external::merge(bindings, external::load_plugin(file, limits), file);
  for (const std::string& command : files.processes)
    external::merge(bindings, external::start_process(command, limits), command);
  d.texts.bindings = d.failed.watch(bindings);
}

PlanningTask::~PlanningTask() = default;
PlanningTask::PlanningTask(PlanningTask&&) noexcept = default;

const TaskFiles& PlanningTask::files() const { return data_->files; }
const plan::TaskTexts& PlanningTask::texts() const { return data_->texts; }
const world::SceneFile* PlanningTask::scene() const {
  return data_->scene ? &*data_->scene : nullptr;
}

plan::Model PlanningTask::load() const {
  const plan::TaskTexts& texts = data_->texts;
  return plan::load(texts.domain, texts.problem ? &*texts.problem : nullptr, texts.bindings);
}

const manipulation::GeometryCounters& PlanningTask::counters() const { return *data_->counters; }
std::vector<plan::FailedCalls::Failure> PlanningTask::failures() const {
  return data_->failed.failures();
}

std::size_t PlanningTask::answers_reused() const {
  return data_->cache ? data_->cache->reused() : 0;
}

void PlanningTask::keep_answers() const {
  if (!data_->cache) return;
  if (const std::string content = data_->cache->content(); !content.empty())
    certify::CacheFolder(certify::CacheFolder::default_folder())
        .store(kAnswers, data_->key, content);
}

}  // namespace kaboum::execution
