// Files and sizes that kaboum-plan is given.

#include "input.h"

#include <kaboum/base/error.h>
#include <kaboum/certify/cache_folder.h>
#include <kaboum/external/plugin.h>
#include <kaboum/external/process.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/manipulation/externals.h>

#include <map>

#include "common/memory_size.h"
#include "common/scene_file.h"
#include "outcomes.h"

namespace kaboum::tools {
namespace {

const std::map<std::string, plan::Language> kLanguages = {{"kpl", plan::Language::Kpl},
                                                          {"pddl", plan::Language::Pddl}};

plan::Text read(const std::string& file, const std::string& format, const char* option) {
  const std::vector<char> bytes = io::read_file(file);
  return {file == "-" ? "stdin" : file, std::string(bytes.begin(), bytes.end()),
          language_of(file, format, option)};
}

}  // namespace

plan::Language language_of(const std::string& file, const std::string& name, const char* option) {
  if (const auto known = kLanguages.find(name); known != kLanguages.end()) return known->second;
  if (const auto guessed = plan::language_from_name(file)) return *guessed;
  throw Error(ErrorCode::InvalidArgument,
              file + ": cannot tell the language from the name; give " + option + " kpl or pddl");
}

PlanTexts read_texts(const PlanOptions& o) {
  PlanTexts t{read(o.domain, o.input_format, "--input-format"), {}};
  if (!o.problem.empty())
    t.problem = read(o.problem, o.problem_format.empty() ? o.input_format : o.problem_format,
                     "--problem-format");
  return t;
}

namespace {

manipulation::ExternalOptions external_options(const PlanOptions& o) {
  manipulation::ExternalOptions out;
  out.counters = o.counters;
  return out;
}

constexpr const char* kAnswers = "KABOUM-ANSWERS 5";

/// One entry for scene, domain and problem: all that answers depend on beside the questions.
void open_cache(ExternalWatch& watch, const SceneFile& scene, const PlanTexts& texts) {
  std::string all = scene.sha256 + '\n' + texts.domain.text + '\n' + version() + '\n';
  if (texts.problem) all += texts.problem->text;
  watch.key = io::sha256({all.data(), all.size()});
  std::string flaw;
  const certify::CacheFolder folder(certify::CacheFolder::default_folder());
  watch.cache = std::make_unique<manipulation::AnswerCache>(
      folder.find(kAnswers, watch.key, flaw).value_or(""));
}

}  // namespace

plan::TaskTexts read_task(const PlanOptions& o, ExternalWatch* watch) {
  PlanTexts texts = read_texts(o);
  plan::ExternalBindings bindings;
  if (!o.scene.empty()) {
    SceneFile scene = read_scene(o.scene);
    for (const std::string& note : scene.notes) log(o.common.quiet, note);
    bindings = manipulation::bind_externals(std::move(scene.world), external_options(o));
    if (watch != nullptr && !o.no_cache) open_cache(*watch, scene, texts);
    if (watch != nullptr && watch->cache) bindings = watch->cache->wrap(bindings);
  }
  for (const std::string& file : o.plugins)
    external::merge(bindings, external::load_plugin(file, {o.process_timeout}), file);
  for (const std::string& command : o.processes)
    external::merge(bindings, external::start_process(command, {o.process_timeout}), command);
  if (watch != nullptr) bindings = watch->explanation.watch(bindings);
  return {std::move(texts.domain), std::move(texts.problem), std::move(bindings)};
}

plan::Model load_model(const PlanOptions& o, ExternalWatch* watch) {
  const plan::TaskTexts task = read_task(o, watch);
  return plan::load(task.domain, task.problem ? &*task.problem : nullptr, task.bindings);
}

std::map<std::string, std::string> read_outcomes(const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  return parse_outcomes({bytes.begin(), bytes.end()}, file);
}

void ExternalWatch::save() const {
  if (!cache) return;
  if (const std::string content = cache->content(); !content.empty())
    certify::CacheFolder(certify::CacheFolder::default_folder()).store(kAnswers, key, content);
}

plan::Plan read_plan_file(const plan::Model& model, const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  return plan::read_plan(model, std::string(bytes.begin(), bytes.end()),
                         file == "-" ? "stdin" : file);
}

std::size_t parse_memory(const std::string& text) { return parse_memory(text, "--max-memory"); }

}  // namespace kaboum::tools
