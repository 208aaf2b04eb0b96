// One HTML page from the files of libpage, with a plan's execution as its data.

#include <kaboum/base/error.h>
#include <kaboum/base/xml_text.h>
#include <kaboum/execution/plan_page.h>
#include <kaboum/execution/recording.h>
#include <kaboum/page/page.h>
#include <kaboum/plan/plan.h>
#include <kaboum/plan/replay.h>
#include <kaboum/world/exact_meshes.h>

#include <filesystem>

namespace kaboum::execution {
namespace {

/// The scene's exact meshes; without them, and a note, where one cannot be read.
std::vector<world::ExactMesh> meshes_of(const PlanningTask& task, const PlanPageOptions& options,
                                        Notes& notes) {
  try {
    return exact_meshes(task.scene()->world, task.files().scene, options.packages);
  } catch (const Error& error) {
    notes.push_back(std::string("only bounding sets are shown: ") + error.what());
    return {};
  }
}

}  // namespace

PlanPage plan_page(const PlanningTask& task, const plan::Model& model, plan::Plan plan,
                   const PlanPageOptions& options) {
  if (task.scene() == nullptr)
    throw Error(ErrorCode::InvalidArgument, "a page shows a scene («scene»): what is to be seen");
  const auto tell = [&](const char* stage) {
    if (options.progress) options.progress(stage);
  };
  const plan::PlanProgress drawing = [&] { tell("drawing the plan"); };
  if (options.tree) plan = plan::expand_tree(plan, plan::kMostTreeNodes, drawing);
  Recording recording(task.scene()->world, model, plan, {});
  plan::RunOptions run;
  run.unplanned = [&](const plan::Unplanned&) { recording.end_unplanned(); };
  plan::run(model, plan, run, [&](const plan::RunStep& step) {
    tell("carrying the plan out");
    recording.carry_out(step);
  });
  PlanPage out;
  const std::string name = model.name.empty()
                               ? std::filesystem::path(task.files().domain).filename().string()
                               : model.name;
  const std::string data = recording.json(meshes_of(task, options, out.notes));
  const std::string note = plan.not_certified.empty() ? "" : ": contacts " + plan.not_certified;
  out.html = page::filled("plan.html", {{"title", escape_xml("Plan " + name + note)},
                                        {"graph", plan::plan_svg(model, plan, drawing)},
                                        {"data", page::in_script(data)}});
  return out;
}

}  // namespace kaboum::execution
