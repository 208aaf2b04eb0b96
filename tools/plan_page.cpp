// One HTML page from the files of player/, with a plan's execution as its data.

#include "plan_page.h"

#include <embedded.h>
#include <kaboum/base/error.h>
#include <kaboum/base/xml_text.h>
#include <kaboum/execution/recording.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <map>

#include "plan_input.h"
#include "scene_file.h"

namespace kaboum::tools {
namespace {

/// JSON as the content of an element <script>: only "</" and "<!" could end or change it.
std::string in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

/// The template with each {{name}} replaced, in one pass: what is put in is not looked at again.
std::string filled(std::string_view page, const std::map<std::string, std::string>& values) {
  std::string out;
  for (;;) {
    const std::size_t begin = page.find("{{");
    out += page.substr(0, begin);
    if (begin == std::string_view::npos) return out;
    const std::size_t end = page.find("}}", begin);
    out += values.at(std::string(page.substr(begin + 2, end - begin - 2)));
    page.remove_prefix(end + 2);
  }
}

/// The scene's exact meshes; without them, and a line on stderr, where one cannot be read.
std::vector<execution::ExactMesh> meshes_of(const SceneFile& scene, const PlanOptions& o) {
  try {
    return execution::exact_meshes(scene.world, o.scene, o.packages);
  } catch (const Error& error) {
    log(o.common.quiet, std::string("only bounding sets are shown: ") + error.what());
    return {};
  }
}

}  // namespace

int write_page(const PlanOptions& o) {
  if (o.scene.empty())
    throw Error(ErrorCode::InvalidArgument, "--html needs --scene: what is there to be seen");
  const SceneFile scene = read_scene(o.scene);
  std::vector<std::string> inputs = scene.inputs;
  inputs.insert(inputs.end(), {o.plan, o.domain, o.problem});
  require_apart({{"--html", o.html}}, inputs);
  const plan::Model model = load_model(o);
  plan::Plan plan = read_plan_file(model, o.plan);
  if (o.tree) plan = plan::expand_tree(plan);
  execution::Recording recording(scene.world, model, plan, {});
  plan::run(model, plan, {}, [&](const plan::RunStep& step) { recording.carry_out(step); });
  const std::string name =
      model.name.empty() ? std::filesystem::path(o.domain).filename().string() : model.name;
  io::write_file(o.html, filled(embedded("page.html"),
                                {{"title", escape_xml("Plan " + name)},
                                 {"graph", plan::plan_svg(model, plan)},
                                 {"data", in_script(recording.json(meshes_of(scene, o)))},
                                 {"scene", std::string(embedded("scene.js"))},
                                 {"player", std::string(embedded("player.js"))}}));
  return kDone;
}

}  // namespace kaboum::tools
