// The options of making a scene: their table.

#include <kaboum/certify/set_options.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/scene/scene_options.h>

namespace kaboum::scene {
namespace {

using R = SceneMaker;

/// An option that sets have, with the text that it has of scenes.
Option<R> of_sets(const std::string& name, const std::string& text) {
  const Option<certify::SetOptions>& option = option_named(certify::set_options(), name);
  const auto stated = [](const certify::SetRequest& sets) {
    certify::SetOptions out{sets, {}};
    out.preparation.drop_sheets = sets.preparation.drop_sheets;
    return out;
  };
  Option<R> out{option,
                [option, stated](const R& r) { return option.value(stated(r.options.sets)); },
                [option, stated](R& r, const std::string& value) {
                  certify::SetOptions options = stated(r.options.sets);
                  option.assign(options, value);
                  r.options.sets = options.request;
                  r.options.sets.preparation.drop_sheets = options.preparation.drop_sheets;
                }};
  out.text = text;
  out.otherwise.clear();
  return out;
}

Option<R> inner_links_option() {
  Option<R> out;
  out.name = "inner-links";
  out.text = "Inner sets of robots' links as well: contacts with them can be certain";
  out.kind = OptionDescription::Kind::Flag;
  out.value = [](const R& r) { return option_text::of(r.options.inner_links.has_value()); };
  out.assign = [](R& r, const std::string& text) {
    r.options.inner_links.reset();
    if (text == "true") r.options.inner_links.emplace();  // all
  };
  return out;
}

std::vector<Option<R>> table() {
  const std::vector<std::pair<const char*, bool>> geometries{{"collision", false},
                                                             {"visual", true}};
  return {
      option<R>(
          {.name = "inner", .text = "Inner sets of objects as well: contacts can be certain"},
          [](auto& r) -> auto& { return r.inner; }),
      inner_links_option(),
      choice<R>(
          option_named(robot::shape_options(), "geometry"),
          [](auto& r) -> auto& { return r.options.visual; }, geometries),
      of_sets("epsilon",
              "Largest distance of the sets from their meshes, a length or a percentage of "
              "each mesh's diagonal"),
      of_sets("effort", "How long to search for the sets"),
      of_sets("drop-sheets", "Drop back-to-back faces without volume, which are then not covered"),
      of_sets("unit",
              "Unit of length of all meshes: m, dm, cm, mm, um, km, in or ft; with robots m"),
      option<R>(
          option_named(robot::shape_options(), "package-path"),
          [](auto& r) -> auto& { return r.options.packages; }),
      option<R>(
          {.name = "force", .text = "Replace a scene that exists, with all that was edited in it"},
          [](auto& r) -> auto& { return r.replace; })};
}

}  // namespace

const std::vector<Option<SceneMaker>>& scene_options() {
  static const std::vector<Option<R>> options = table();
  return options;
}

const std::vector<Option<SceneMaker>>& update_options() {
  static const std::vector<Option<SceneMaker>> options =
      options_named(scene_options(), {"package-path"});
  return options;
}

}  // namespace kaboum::scene
