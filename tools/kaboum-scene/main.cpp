// The program kaboum-scene: makes scenes, brings them up to date, finds pairs that never touch, and
// derives grasps and places.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/scene/scene_options.h>
#include <kaboum/scene/scene_update.h>
#include <kaboum/world/scene.h>

#include <CLI/CLI.hpp>

#include "derived_page.h"
#include "names.h"
#include "options.h"
#include "pairs.h"

namespace {

using namespace kaboum;  // the tool's own names are few

std::vector<scene::NamedFile> named_files(const std::vector<std::string>& texts,
                                          const char* option) {
  std::vector<scene::NamedFile> out;
  out.reserve(texts.size());
  for (const std::string& text : texts) out.push_back(tools::parse_named_file(text, option));
  return out;
}

/// Of a mesh, by its extension. @throws Error saying what to do with others
io::Format format_of(const std::string& file) {
  return tools::format_for(file, "", "--input-format");
}

/// @return the exit code
int say_made(const tools::SceneOptions& o, const scene::MadeScene& made, const std::string& what,
             const char* command) {
  for (const std::string& line : made.notes) tools::log(o.common.quiet, line);
  for (const std::string& size : made.sizes) tools::log(o.common.quiet, size);
  tools::log(o.common.quiet, what);
  for (const std::string& link : made.bad_links) tools::log(false, link);
  tools::write_report(o.common, "kaboum-scene",
                      {{"command", command},
                       {"scene", o.scene},
                       {"sets", made.containers.size()},
                       {"inputs", made.inputs},
                       {"bad_links", made.bad_links},
                       {"notes", made.notes}});
  return made.bad_links.empty() ? tools::kDone : tools::kNo;
}

int make_scene(const tools::SceneOptions& o) {
  const tools::ThreadLimit threads(o.common.threads);
  scene::SceneMaker maker = o.make;
  bring_lengths_into(maker.options.sets.unit, scene::scene_options(), maker);
  maker.scene = o.scene;
  maker.robots = named_files(o.robots, "--robot");
  maker.objects = named_files(o.objects, "--object");
  for (const std::string& text : o.primitives)
    maker.primitives.push_back(
        tools::parse_primitive(text, "--primitive", maker.options.sets.unit));
  maker.regions = named_files(o.regions, "--region");
  maker.places = tools::parse_places(o.places, "--at");
  maker.scales = tools::parse_scales(o.scales, "--scale");
  std::vector<std::string> inputs;
  for (const auto* files : {&maker.robots, &maker.objects, &maker.regions})
    for (const scene::NamedFile& file : *files) inputs.push_back(file.file);
  scene::require_free_place(o.scene, maker.replace);
  tools::require_apart({{"SCENE", o.scene}, {"--report", o.common.report}}, inputs);
  maker.options.format_of = format_of;
  const certify::SetCache cache(o.cache.empty() ? certify::SetCache::default_folder()
                                                : std::filesystem::path(o.cache));
  if (!o.no_cache) maker.options.cache = &cache;
  tools::Progress progress(o.common.quiet);
  maker.options.progress = [&](const std::string& stage) { progress.show(stage); };
  const scene::MadeScene made = scene::make_scene(maker);
  return say_made(o, made,
                  o.scene + ": " + std::to_string(made.containers.size()) + " sets" +
                      (maker.places.size() < inputs.size()
                           ? ", what --at does not name at the origin: put things where they belong"
                           : ""),
                  "make");
}

int update_scene(const tools::SceneOptions& o) {
  const tools::ThreadLimit threads(o.common.threads);
  tools::require_apart({{"--report", o.common.report}}, scene::files_of(o.scene));
  const certify::SetCache cache(o.cache.empty() ? certify::SetCache::default_folder()
                                                : std::filesystem::path(o.cache));
  tools::Progress progress(o.common.quiet);
  const scene::MadeScene made =
      scene::update_scene({o.scene, o.make.options.packages, o.no_cache ? nullptr : &cache,
                           [&](const std::string& stage) { progress.show(stage); }, format_of});
  return say_made(
      o, made,
      o.scene + ": " +
          (made.containers.empty() ? std::string("nothing is out of date")
                                   : std::to_string(made.containers.size()) + " sets made anew"),
      "update");
}

/// @return the exit code
int say_added(const tools::SceneOptions& o, const scene::AddedFeatures& added,
              const char* command) {
  bool all = true;
  tools::Json objects = tools::Json::array(), notes = tools::Json::array();
  for (const std::string& note : added.notes) {
    notes.push_back(remedy_of_program(note));
    tools::log(o.common.quiet, notes.back());
  }
  for (const scene::AddedFeatures::OfObject& object : added.objects) {
    all = all && object.shortfall.empty();
    std::string line = object.object + ": ";
    const auto count = [](const std::vector<std::string>& names, const char* what) {
      return std::to_string(names.size()) + what + " (" + names.front() + " …)";
    };
    if (!object.names.empty()) line += count(object.names, "");
    if (!object.kept.empty())
      line += (object.names.empty() ? "" : ", ") + count(object.kept, " kept");
    if (object.names.empty() && object.kept.empty()) line += "none";
    if (!object.shortfall.empty()) line += "; " + object.shortfall;
    tools::log(o.common.quiet && object.shortfall.empty(), line);
    // What the answer does not hold for is said whatever is quiet.
    if (object.shortfall.empty())
      for (const std::string& link : object.unchecked)
        tools::log(false, object.object + ": whether " + link +
                              " touches it was not looked at (no set, or an allowed contact)");
    objects.push_back({{"object", object.object},
                       {"names", object.names},
                       {"kept", object.kept},
                       {"shortfall", object.shortfall},
                       {"unchecked", object.unchecked}});
  }
  tools::write_report(o.common, "kaboum-scene",
                      {{"command", command},
                       {"scene", o.scene},
                       {"objects", std::move(objects)},
                       {"notes", std::move(notes)}});
  return all ? tools::kDone : tools::kNo;
}

int add_grasps(const tools::SceneOptions& o) {
  const tools::ThreadLimit threads(o.common.threads);
  tools::require_apart({{"--report", o.common.report}, {"--preview", o.preview}},
                       scene::files_of(o.scene));
  const scene::AddedFeatures added = scene::add_grasps(o.scene, o.objects, o.derived_grasps);
  if (!o.preview.empty()) {
    const std::string page =
        tools::page_of_grasps(o.scene, world::read_scene(o.scene).world, added, o.derived_grasps);
    io::write_file(o.preview, {page.data(), page.size()});
  }
  return say_added(o, added, "grasps");
}

int add_places(const tools::SceneOptions& o) {
  const tools::ThreadLimit threads(o.common.threads);
  tools::require_apart({{"--report", o.common.report}, {"--preview", o.preview}},
                       scene::files_of(o.scene));
  const scene::AddedFeatures added = scene::add_places(o.scene, o.objects, o.derived_places);
  if (!o.preview.empty()) {
    const std::string page =
        tools::page_of_places(o.scene, world::read_scene(o.scene).world, added);
    io::write_file(o.preview, {page.data(), page.size()});
  }
  return say_added(o, added, "places");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Makes scenes for kaboum-check and planners, examines their robots, and derives grasps and "
      "places.",
      "kaboum-scene"};
  tools::SceneOptions options;
  CLI::App* make = tools::describe_make(app, options);
  CLI::App* update = tools::describe_update(app, options);
  tools::describe_pairs(app, options);
  CLI::App* grasps = tools::describe_grasps(app, options);
  CLI::App* places = tools::describe_places(app, options);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 a link of a robot is not held as asked for, an object has no such "
      "grasp or point, or no link of the hand was looked at (the rest is written); 2 usage; 3 bad "
      "input; 4 output failed; 5 not built; 6 internal error; 7 limit.");
  return tools::run(app, argc, argv, [&] {
    if (make->parsed()) return make_scene(options);
    if (grasps->parsed()) return add_grasps(options);
    if (places->parsed()) return add_places(options);
    return update->parsed() ? update_scene(options) : tools::find_pairs(options);
  });
}
