// One HTML page from the files of player/, with a plan's execution as its data.

#include "page.h"

#include <kaboum/base/error.h>
#include <kaboum/base/xml_text.h>
#include <kaboum/execution/recording.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>

#include "common/scene_file.h"
#include "input.h"
#include "player/page.h"

namespace kaboum::tools {
namespace {

/// The scene's exact meshes; without them, and a line on stderr, where one cannot be read.
std::vector<execution::ExactMesh> meshes_of(const SceneFile& scene, const PlanOptions& o) {
  try {
    return execution::exact_meshes(scene.world, o.task.scene, o.run.packages);
  } catch (const Error& error) {
    log(o.common.quiet, std::string("only bounding sets are shown: ") + error.what());
    return {};
  }
}

}  // namespace

int write_page(const PlanOptions& o) {
  if (o.task.scene.empty())
    throw Error(ErrorCode::InvalidArgument, "--html needs --scene: what is there to be seen");
  const execution::PlanningTask task = read_task(o);
  const SceneFile& scene = *task.scene();
  std::vector<std::string> inputs = scene.inputs;
  inputs.insert(inputs.end(), {o.plan, o.task.domain, o.task.problem});
  require_apart({{"--html", o.html}}, inputs);
  const plan::Model model = task.load();
  plan::Plan plan = read_plan_file(model, o.plan);
  if (o.tree) plan = plan::expand_tree(plan);
  execution::Recording recording(scene.world, model, plan, {});
  plan::RunOptions options;
  options.unplanned = [&](const plan::Unplanned&) { recording.end_unplanned(); };
  plan::run(model, plan, options, [&](const plan::RunStep& step) { recording.carry_out(step); });
  const std::string name =
      model.name.empty() ? std::filesystem::path(o.task.domain).filename().string() : model.name;
  io::write_file(
      o.html,
      page::filled("plan.html", {{"title", escape_xml("Plan " + name)},
                                 {"graph", plan::plan_svg(model, plan)},
                                 {"data", page::in_script(recording.json(meshes_of(scene, o)))}}));
  return kDone;
}

}  // namespace kaboum::tools
